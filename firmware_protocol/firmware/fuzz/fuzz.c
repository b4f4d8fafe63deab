/* libFuzzer: any bytes, in any rhythm, over the core. The first byte of each chunk says what happens besides.
 *
 * It is a fault if the sanitizers say so, if the device no longer answers a HELLO, or if more is written to the panel
 * than the bytes that came can stand for.
 */
#include <stdlib.h>
#include <string.h>

#include "../host/host.h"
#include "cycle.h"
#include "paneldraw.h"

/* A HELLO that knows all features. */
static const uint8_t hello[] = {0x00, 0x02, 0x01, 0x08, 0x04, 0x03, 0x02, 0x01,
                                0x01, 0x01, 0x07, 0x03, 0xa0, 0x91, 0x00};

void host_start(uint16_t boot, uint8_t cause);
void host_set(bool gone, bool slow, bool stuck);

/* A repeat of 65 and what the bus notes of a transaction, for two bytes; and while a cycle goes on, for as many as the
 * store has with each turn.
 */
#define MOST_WRITTEN 34

static unsigned answered;
static size_t came, written, turned;

static void receive(uint8_t byte)
{
    came++;
    pd_receive(byte);
}

static void look_at_panel(void)
{
    written += host.size;
    host.size = 0;
    if (written > MOST_WRITTEN * (came + PD_STORE_SIZE * turned))
        abort();
}

static void turns(unsigned count, uint16_t now)
{
    uint8_t byte;
    host.ticks = now * 250;
    while (count--) {
        turned += cycle_goes_on();
        pd_poll(now);
        while (pd_transmit(&byte))
            answered++;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint16_t now = 0;
    host_start(1, 1);
    answered = 0;
    came = written = turned = 0;
    for (size_t i = 0; i < sizeof hello && size && data[0] & 1; i++) {
        receive(hello[i]);
        turns(3, now);
    }
    while (size >= 2) {
        uint8_t what = data[0];
        size_t chunk = data[1] < size - 2 ? data[1] : size - 2;
        host_set(what & 1, what & 2, (what & 0x0C) == 0x0C);
        if ((what & 0x30) == 0x30)
            pd_line_error();
        for (size_t i = 0; i < chunk; i++) {
            receive(data[2 + i]);
            if (what & 0x40)
                turns(1, now);
            if (what & 0x80)
                host_bus_step();
        }
        look_at_panel();
        now += what & 0x1F;
        turns(4, now);
        data += 2 + chunk;
        size -= 2 + chunk;
    }
    /* Whatever came: when time has passed and the bus is free, the device speaks. */
    host_set(false, false, false);
    while (host_bus_step())
        ;
    for (int i = 0; i < 100; i++)
        turns(40, now += 40);
    answered = 0;
    for (size_t i = 0; i < sizeof hello; i++) {
        receive(hello[i]);
        turns(2, now);
    }
    turns(200, now);
    look_at_panel();
    if (answered < 40)
        abort();
    return 0;
}
