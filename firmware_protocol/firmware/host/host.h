#ifndef PANELDRAW_HOST_H
#define PANELDRAW_HOST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct host {
    bool gone, slow, stuck; /* the panel does not answer, takes one step at a time, holds the bus */
    bool on, idle;
    uint8_t status; /* what the panel gives when it is read */
    uint32_t rate;
    uint16_t ticks;
    unsigned resets;
    size_t size, length;
    uint8_t bytes[60000];
};
extern struct host host;

bool host_bus_step(void);

#endif
