/* A panel's bus that notes what is written, at once or step by step. */
#include "host.h"

#include "paneldraw.h"

struct host host;

static void note(uint8_t byte)
{
    if (host.size < sizeof host.bytes)
        host.bytes[host.size++] = byte;
}

void pd_port_bus_start(void)
{
    host.on = true;
    host.idle = true;
    if (!host.slow)
        while (host_bus_step())
            ;
}

void pd_port_bus_abort(void)
{
    host.on = false;
}

/* One step of the bus; false when there is none. A transaction is noted as its length in two bytes and its bytes. */
bool host_bus_step(void)
{
    if (!host.on || host.stuck)
        return false;
    uint16_t step = pd_bus_next();
    if ((step == PD_START || step == PD_READ) && host.gone) {
        host.on = false;
        pd_bus_done(PD_ADDRESS_NACK);
        return false;
    }
    if (step == PD_READ) {
        pd_bus_took(host.status);
    } else if (step == PD_START) {
        host.idle = false;
        host.length = host.size;
        note(0);
        note(0);
    } else if (step == PD_STOP) {
        host.on = false;
        pd_bus_done(PD_OK);
        return false;
    } else if (!host.idle && host.length + 1 < sizeof host.bytes) {
        note((uint8_t)step);
        if (!++host.bytes[host.length])
            host.bytes[host.length + 1]++;
    }
    return true;
}

void pd_port_transmit(void) {}

bool pd_port_transmitted(void)
{
    return true;
}

void pd_port_set_rate(uint32_t rate)
{
    host.rate = rate;
}

uint16_t pd_port_ticks(void)
{
    return host.ticks;
}

void pd_port_reset_panel(void)
{
    host.resets++;
}

/* The same through functions, for Python. */

void host_start(uint16_t boot, uint8_t cause)
{
    host = (struct host){.rate = 115200};
    pd_start(boot, cause);
}

void host_set(bool gone, bool slow, bool stuck)
{
    host.gone = gone;
    host.slow = slow;
    host.stuck = stuck;
}

/* Takes bytes from the line, one at a time, and lets the device work on each; returns how many bytes it answers. */
uint16_t host_receive(const uint8_t *bytes, uint16_t size, uint8_t *answer, uint16_t room, uint16_t milliseconds)
{
    uint16_t answered = 0;
    host.ticks = milliseconds * 250;
    for (uint16_t i = 0; i <= size; i++) {
        if (i < size)
            pd_receive(bytes[i]);
        for (uint8_t turn = 0; turn < 10; turn++) {
            pd_poll(milliseconds);
            while (answered < room && pd_transmit(answer + answered))
                answered++;
        }
    }
    return answered;
}

uint16_t host_written(uint8_t *bytes)
{
    uint16_t size = (uint16_t)host.size;
    for (uint16_t i = 0; i < size; i++)
        bytes[i] = host.bytes[i];
    host.size = 0;
    return size;
}

void host_set_status(uint8_t status)
{
    host.status = status;
}

unsigned host_resets(void)
{
    return host.resets;
}

uint32_t host_rate(void)
{
    return host.rate;
}

void host_line_error(void)
{
    pd_line_error();
}
