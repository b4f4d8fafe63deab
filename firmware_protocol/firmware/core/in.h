/* Between the line and the state machine: the frame that is coming in, decoded where it lies in the ring. */
#ifndef PANELDRAW_IN_H
#define PANELDRAW_IN_H

#include "paneldraw.h"

/* Bytes of a decoded frame that are not payload: kind, seq and the checksum. */
#define IN_ENVELOPE 4

struct in {
    uint16_t read;       /* up to here the ring has been read */
    uint16_t start, end; /* what is decoded of the frame; never beyond read */
    uint16_t length, crc;
    uint8_t block, left; /* the COBS block, and how many of its bytes are to come */
    bool damaged;
};
extern struct in in;

enum in_event { IN_IDLE, IN_PART, IN_FRAME, IN_DAMAGED };

/* Decodes some of what has come, if anything has, to the end of a frame at most; after one, in_begin begins the next. */
enum in_event in_decode(void);
void in_begin(void);
/* Throws away what has come. */
void in_skip(void);

#endif
