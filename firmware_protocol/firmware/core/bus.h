/* Between the state machine and the tokens of a WRITE. */
#ifndef PANELDRAW_BUS_H
#define PANELDRAW_BUS_H

#include "paneldraw.h"

enum pd_bus_state { PD_BUS_IDLE, PD_BUS_BUSY, PD_BUS_DONE };

/* The mask of places in memory that is no ring. */
#define PD_UNBOUNDED 0xFFFF

/* Tokens in memory, or in a ring, of which each part of data stands in several copies. */
struct pd_tokens {
    const uint8_t *memory;
    uint16_t mask; /* of places there */
    uint16_t at, end;
    uint8_t copies, copy; /* how many there are, and which one is meant */
};

struct pd_bus {
    struct pd_tokens tokens;
    uint16_t rest;        /* bytes of copies to be passed over after the data */
    uint8_t left;         /* bytes left of the commands, the data or the repeat */
    uint8_t trailing;     /* data bytes of the token that come after its commands */
    uint8_t value;        /* the byte that is repeated, or was read */
    uint8_t run;          /* what the transaction carries */
    bool repeats;         /* whether it is a repeat */
    bool control;         /* whether a control byte is due */
    volatile uint8_t state;
    volatile uint8_t fault;
    volatile uint8_t steps; /* counts on while the bus moves */
};
extern struct pd_bus pd_bus;

/* Whether tokens are whole. */
bool pd_tokens_valid(const struct pd_tokens *tokens);
/* Write them to the panel; with none, see whether the panel answers. */
void pd_bus_write(const struct pd_tokens *tokens);
/* Read a byte from the panel, to pd_bus.value. */
void pd_bus_read(void);

#endif
