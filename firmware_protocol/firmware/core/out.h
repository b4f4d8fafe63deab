/* Between the state machine and the line: a frame is begun, filled and finished; pd_transmit gives its bytes. */
#ifndef PANELDRAW_OUT_H
#define PANELDRAW_OUT_H

#include "paneldraw.h"

void out_begin(uint8_t kind, uint8_t seq);
/* The same behind a delimiter of its own: the rest of a frame that broke off does not swallow it. */
void out_begin_apart(uint8_t kind, uint8_t seq);
void out_byte(uint8_t byte);
/* The lowest bytes of a number, lowest first. */
void out_put(uint16_t value, uint8_t bytes);
void out_finish(void);
/* How many bytes there is room for. */
uint8_t out_room(void);
void out_clear(void);

#endif
