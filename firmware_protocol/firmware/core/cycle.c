/* The store: how long each sub-picture lasts, and tokens that are the same for all of them but for their data. */
#include "cycle.h"

#include "bus.h"

#define LEAST_TICKS 250
#define TICKS_SIZE 2

static uint8_t store[PD_STORE_SIZE ? PD_STORE_SIZE : 1];

static struct {
    bool on;
    uint16_t began; /* in ticks, when the sub-picture that is shown was due */
    struct pd_tokens tokens;
} cycle = {.tokens = {store, PD_UNBOUNDED, 0, 0, 1, 0}};

#if PD_FRAME_LINE
static volatile bool pulsed;

void pd_frame(void)
{
    pulsed = true;
}
#endif

static uint16_t number(uint16_t at)
{
    return pd_rx.ring[at & PD_RING_MASK] | pd_rx.ring[(at + 1) & PD_RING_MASK] << 8;
}

static uint16_t ticks_of(uint8_t sub_picture)
{
    return store[sub_picture * TICKS_SIZE] | store[sub_picture * TICKS_SIZE + 1] << 8;
}

bool cycle_store(uint16_t at, uint16_t end)
{
    uint16_t left = (end - at) & PD_RING_MASK;
    if (left < 2)
        return false;
    uint16_t to = number(at);
    left -= 2;
    if (to > PD_STORE_SIZE || left > PD_STORE_SIZE - to)
        return false;
    for (at += 2; left; left--)
        store[to++] = pd_rx.ring[at++ & PD_RING_MASK];
    return true;
}

/* Whether the store holds what was said of it. */
static bool holds(void)
{
    cycle.tokens.at = cycle.tokens.copies * TICKS_SIZE;
    if (cycle.tokens.end > PD_STORE_SIZE || cycle.tokens.end < cycle.tokens.at)
        return false;
    for (uint8_t each = 0; each < cycle.tokens.copies; each++)
        if (ticks_of(each) < LEAST_TICKS)
            return false;
    return pd_tokens_valid(&cycle.tokens);
}

bool cycle_begin(uint16_t at, uint16_t end)
{
    uint16_t size = (end - at) & PD_RING_MASK;
    if (!size)
        return true;
    if (size < 3)
        return false;
    cycle.tokens.end = number(at);
    cycle.tokens.copies = pd_rx.ring[(at + 2) & PD_RING_MASK];
    if (!cycle.tokens.copies)
        return true;
    if (!holds())
        return false;
    cycle.tokens.copy = 0;
    cycle.began = pd_port_ticks();
    cycle.on = true;
    return true;
}

bool cycle_goes_on(void)
{
    return PD_STORE_SIZE && cycle.on;
}

bool cycle_within(void)
{
    return cycle.tokens.copy;
}

/* A frame line sets the pace where it keeps about to the time; one that is silent does not stop the cycle. */
bool cycle_due(void)
{
    uint16_t passed = pd_port_ticks() - cycle.began, ticks = ticks_of(cycle.tokens.copy);
#if PD_FRAME_LINE
    if (pulsed) {
        pulsed = false;
        if (passed >= ticks - ticks / 4)
            return true;
    }
    return passed >= (uint32_t)ticks + ticks / 4;
#else
    return passed >= ticks;
#endif
}

void cycle_turn(bool first)
{
    uint16_t now = pd_port_ticks();
    uint8_t copy = cycle.tokens.copy;
    cycle.began += ticks_of(copy);
    copy = first || copy + 1 == cycle.tokens.copies ? 0 : copy + 1;
    if (PD_FRAME_LINE || (uint16_t)(now - cycle.began) >= ticks_of(copy))
        cycle.began = now; /* too late for the next one to be in time */
    cycle.tokens.copy = copy;
    pd_bus_write(&cycle.tokens);
}

void cycle_end(void)
{
    cycle.on = false;
    cycle.tokens.copy = 0;
}

void cycle_clear(void)
{
    cycle_end();
    for (uint16_t at = 0; at < PD_STORE_SIZE; at++)
        store[at] = 0;
}
