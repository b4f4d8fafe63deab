/* The tokens of a WRITE, as transactions on the panel's bus. */
#include "bus.h"

#define COMMANDS 0x80
#define REPEATS 0xC0

enum { RUN_NONE, RUN_COMMANDS, RUN_DATA, RUN_PROBE, RUN_READ };

struct pd_bus pd_bus;

static inline uint8_t commands_of(uint8_t header)
{
    return (header & 7) + 1;
}

static inline uint8_t trailing_of(uint8_t header)
{
    return header >> 3 & 7;
}

bool pd_tokens_valid(const uint8_t *memory, uint16_t mask, uint16_t at, uint16_t end)
{
    uint16_t left = (end - at) & mask;
    while (left) {
        uint8_t header = memory[at];
        uint8_t size = 2;
        if (header >= REPEATS && !PD_REPEATS)
            return false;
        if (header < COMMANDS)
            size = header + 2;
        else if (header < REPEATS)
            size = 1 + commands_of(header) + trailing_of(header);
        if (size > left)
            return false;
        left -= size;
        at = (at + size) & mask;
    }
    return true;
}

static void begin(uint16_t at, uint16_t end, uint8_t run)
{
    pd_bus.at = at;
    pd_bus.end = end;
    pd_bus.left = pd_bus.trailing = 0;
    pd_bus.control = false;
    pd_bus.run = run;
    PD_GUARDED(pd_bus.state = PD_BUS_BUSY); /* not before the rest is there */
    pd_port_bus_start();
}

void pd_bus_write(const uint8_t *memory, uint16_t mask, uint16_t at, uint16_t end)
{
    pd_bus.memory = memory;
    pd_bus.mask = mask;
    begin(at, end, at == end ? RUN_PROBE : RUN_NONE);
}

void pd_bus_read(void)
{
    begin(0, 0, RUN_READ);
}

void pd_bus_took(uint8_t byte)
{
    pd_bus.value = byte;
}

void pd_bus_done(enum pd_fault fault)
{
    pd_bus.fault = fault;
    pd_bus.state = PD_BUS_DONE;
}

static inline uint8_t take(void)
{
    uint16_t at = pd_bus.at;
    pd_bus.at = (at + 1) & pd_bus.mask;
    return pd_bus.memory[at];
}

/* Goes on to the next bytes of one kind; returns what they carry. The tokens are not at their end. */
static uint8_t open_part(void)
{
    pd_bus.repeats = false;
    if (pd_bus.trailing) {
        pd_bus.left = pd_bus.trailing;
        pd_bus.trailing = 0;
        return RUN_DATA;
    }
    uint8_t header = take();
    if (header < COMMANDS) {
        pd_bus.left = header + 1;
    } else if (header < REPEATS) {
        pd_bus.left = commands_of(header);
        pd_bus.trailing = trailing_of(header);
        return RUN_COMMANDS;
    } else {
        pd_bus.repeats = true;
        pd_bus.left = (uint8_t)(0x101 - header);
        pd_bus.value = take();
    }
    return RUN_DATA;
}

uint16_t pd_bus_next(void)
{
    pd_bus.steps++;
    if (!pd_bus.left) {
        if (pd_bus.run == RUN_PROBE) {
            pd_bus.run = RUN_NONE;
            return PD_START;
        }
        if (PD_READS && pd_bus.run == RUN_READ) {
            pd_bus.run = RUN_NONE;
            return PD_READ;
        }
        if (pd_bus.at == pd_bus.end)
            return PD_STOP;
        uint8_t run = open_part();
        if (run != pd_bus.run) {
            pd_bus.run = run;
            pd_bus.control = true;
            return PD_START;
        }
    }
    if (pd_bus.control) {
        pd_bus.control = false;
        return pd_bus.run == RUN_DATA ? 0x40 : PD_CONTROL_EACH ? 0x80 : 0x00;
    }
    pd_bus.left--;
    pd_bus.control = PD_CONTROL_EACH && pd_bus.run == RUN_COMMANDS;
    return pd_bus.repeats ? pd_bus.value : take();
}
