/* The tokens of a WRITE, as transactions on the panel's bus. */
#include "bus.h"

#define COMMANDS 0x80
#define REPEATS 0xA0

enum { RUN_NONE, RUN_COMMANDS, RUN_DATA, RUN_PROBE };

struct pd_bus pd_bus;

static inline uint8_t run_of(uint8_t header)
{
    return header >= COMMANDS && header < REPEATS ? RUN_COMMANDS : RUN_DATA;
}

static inline uint8_t length_of(uint8_t header)
{
    return header >= COMMANDS ? header - COMMANDS + 1 : header + 1;
}

bool pd_tokens_valid(uint16_t at, uint16_t end)
{
    uint16_t left = (end - at) & PD_RING_MASK;
    while (left) {
        uint8_t header = pd_rx.ring[at];
        uint8_t size = header >= REPEATS ? 2 : length_of(header) + 1;
        if (size > left)
            return false;
        left -= size;
        at = (at + size) & PD_RING_MASK;
    }
    return true;
}

void pd_bus_write(uint16_t at, uint16_t end)
{
    pd_bus.at = at;
    pd_bus.end = end;
    pd_bus.left = 0;
    pd_bus.control = false;
    pd_bus.run = at == end ? RUN_PROBE : RUN_NONE;
    PD_GUARDED(pd_bus.state = PD_BUS_BUSY); /* not before the rest is there */
    pd_port_bus_start();
}

void pd_bus_done(enum pd_fault fault)
{
    pd_bus.fault = fault;
    pd_bus.state = PD_BUS_DONE;
}

static inline uint8_t take(void)
{
    uint16_t at = pd_bus.at;
    pd_bus.at = (at + 1) & PD_RING_MASK;
    return pd_rx.ring[at];
}

uint16_t pd_bus_next(void)
{
    pd_bus.steps++;
    if (!pd_bus.left) {
        if (pd_bus.run == RUN_PROBE) {
            pd_bus.run = RUN_NONE;
            return PD_START;
        }
        if (pd_bus.at == pd_bus.end)
            return PD_STOP;
        uint8_t header = pd_rx.ring[pd_bus.at];
        uint8_t run = run_of(header);
        if (run != pd_bus.run) {
            pd_bus.run = run;
            pd_bus.control = true;
            return PD_START;
        }
        if (pd_bus.control && (run == RUN_DATA || !PD_CONTROL_EACH)) {
            pd_bus.control = false;
            return run == RUN_DATA ? 0x40 : 0x00;
        }
        take();
        pd_bus.repeats = header >= REPEATS;
        if (pd_bus.repeats) {
            pd_bus.left = (uint8_t)(0x101 - header);
            pd_bus.value = take();
        } else {
            pd_bus.left = length_of(header);
        }
    }
    if (PD_CONTROL_EACH && pd_bus.run == RUN_COMMANDS) {
        pd_bus.control = !pd_bus.control;
        if (!pd_bus.control)
            return 0x80;
    }
    pd_bus.left--;
    return pd_bus.repeats ? pd_bus.value : take();
}
