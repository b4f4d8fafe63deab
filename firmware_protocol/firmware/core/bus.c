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

bool pd_tokens_valid(const struct pd_tokens *tokens)
{
    uint16_t at = tokens->at, left = (tokens->end - at) & tokens->mask;
    while (left) {
        uint8_t header = tokens->memory[at];
        uint8_t commands = 0, data = 1;
        if (header >= REPEATS && !PD_REPEATS)
            return false;
        if (header < COMMANDS) {
            data = header + 1;
        } else if (header < REPEATS) {
            commands = commands_of(header);
            data = trailing_of(header);
        }
        uint16_t size = 1 + commands + (uint16_t)(data * tokens->copies);
        if (size > left)
            return false;
        left -= size;
        at = (at + size) & tokens->mask;
    }
    return true;
}

static void begin(uint8_t run)
{
    pd_bus.rest = pd_bus.left = pd_bus.trailing = 0;
    pd_bus.control = false;
    pd_bus.run = run;
    PD_GUARDED(pd_bus.state = PD_BUS_BUSY); /* not before the rest is there */
    pd_port_bus_start();
}

void pd_bus_write(const struct pd_tokens *tokens)
{
    pd_bus.tokens = *tokens;
    begin(tokens->at == tokens->end ? RUN_PROBE : RUN_NONE);
}

void pd_bus_read(void)
{
    pd_bus.tokens.at = pd_bus.tokens.end;
    begin(RUN_READ);
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
    uint16_t at = pd_bus.tokens.at;
    pd_bus.tokens.at = (at + 1) & pd_bus.tokens.mask;
    return pd_bus.tokens.memory[at];
}

static inline void pass_over(uint16_t bytes)
{
    pd_bus.tokens.at = (pd_bus.tokens.at + bytes) & pd_bus.tokens.mask;
}

/* Goes to the copy that is meant of data of a size. */
static void open_data(uint8_t size)
{
    pd_bus.left = size;
    if (pd_bus.tokens.copies > 1) {
        pass_over(size * pd_bus.tokens.copy);
        pd_bus.rest = size * (pd_bus.tokens.copies - 1 - pd_bus.tokens.copy);
    }
}

/* Goes on to the next bytes of one kind; returns what they carry. The tokens are not at their end. */
static uint8_t open_part(void)
{
    pd_bus.repeats = false;
    if (pd_bus.trailing) {
        open_data(pd_bus.trailing);
        pd_bus.trailing = 0;
        return RUN_DATA;
    }
    uint8_t header = take();
    if (header < COMMANDS) {
        open_data(header + 1);
    } else if (header < REPEATS) {
        pd_bus.left = commands_of(header);
        pd_bus.trailing = trailing_of(header);
        return RUN_COMMANDS;
    } else {
        open_data(1);
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
        pass_over(pd_bus.rest);
        pd_bus.rest = 0;
        if (!pd_bus.trailing && pd_bus.tokens.at == pd_bus.tokens.end)
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
