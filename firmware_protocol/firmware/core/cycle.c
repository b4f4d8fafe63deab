/* The store: strings of tokens, each with its length in two bytes ahead, one for each sub-picture. */
#include "cycle.h"

#include "bus.h"

#define LEAST_PERIOD 250
#define LENGTH 2

static uint8_t store[PD_STORE_SIZE ? PD_STORE_SIZE : 1];

static struct {
    bool on;
    uint8_t count, turn;
    uint16_t at, period, began; /* where the next one stands; ticks */
} cycle;

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

static uint16_t length_at(uint16_t at)
{
    return store[at] | store[at + 1] << 8;
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

/* Whether the store holds so many sub-pictures. */
static bool holds(uint8_t count)
{
    uint16_t at = 0;
    for (; count; count--) {
        if (PD_STORE_SIZE - at < LENGTH)
            return false;
        uint16_t length = length_at(at);
        at += LENGTH;
        if (length > PD_STORE_SIZE - at || !pd_tokens_valid(store, PD_UNBOUNDED, at, at + length))
            return false;
        at += length;
    }
    return true;
}

bool cycle_begin(uint16_t at, uint16_t end)
{
    uint16_t size = (end - at) & PD_RING_MASK;
    if (!size)
        return true;
    if (size < 3)
        return false;
    cycle.period = number(at);
    cycle.count = pd_rx.ring[(at + 2) & PD_RING_MASK];
    if (!cycle.count)
        return true;
    if (cycle.period < LEAST_PERIOD || !holds(cycle.count))
        return false;
    cycle.at = cycle.turn = 0;
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
    return cycle.turn;
}

/* A frame line sets the pace where it keeps about to the period; one that is silent does not stop the cycle. */
bool cycle_due(void)
{
    uint16_t passed = pd_port_ticks() - cycle.began;
#if PD_FRAME_LINE
    if (pulsed) {
        pulsed = false;
        if (passed >= cycle.period - cycle.period / 4)
            return true;
    }
    return passed >= (uint32_t)cycle.period + cycle.period / 4;
#else
    return passed >= cycle.period;
#endif
}

void cycle_turn(void)
{
    uint16_t now = pd_port_ticks(), at = cycle.at + LENGTH;
    cycle.began += cycle.period;
    if (PD_FRAME_LINE || (uint16_t)(now - cycle.began) >= cycle.period)
        cycle.began = now; /* too late for the next one to be in time */
    cycle.at = at + length_at(cycle.at);
    cycle.turn++;
    uint16_t end = cycle.at;
    if (cycle.turn == cycle.count)
        cycle.at = cycle.turn = 0;
    pd_bus_write(store, PD_UNBOUNDED, at, end);
}

void cycle_end(void)
{
    cycle.on = false;
    cycle.turn = 0;
}

void cycle_clear(void)
{
    cycle_end();
    for (uint16_t at = 0; at < PD_STORE_SIZE; at++)
        store[at] = 0;
}
