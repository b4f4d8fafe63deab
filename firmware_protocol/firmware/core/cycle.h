/* Between the state machine and the store: the sub-pictures that are written to the panel in turn. */
#ifndef PANELDRAW_CYCLE_H
#define PANELDRAW_CYCLE_H

#include "paneldraw.h"

/* Both take a payload in the ring, and return whether it is well formed. */
bool cycle_store(uint16_t at, uint16_t end);
bool cycle_begin(uint16_t at, uint16_t end);

/* Whether a cycle goes on; whether the panel shows another sub-picture than the first; whether the next is due. */
bool cycle_goes_on(void);
bool cycle_within(void);
bool cycle_due(void);
/* Begins to write the next sub-picture to the panel's bus, or the first. */
void cycle_turn(bool first);
void cycle_end(void);
/* Ends the cycle and forgets the store. */
void cycle_clear(void);

#endif
