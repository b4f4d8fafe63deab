/* The panel on SSI0 (SPI), written by waiting; the D/C line is port C, pin 7. A memory card shares the bus. */
#include "board.h"

#define SSI(offset) REG(0x40008000 + (offset))
#define SSI_FRAME 0x00
#define SSI_ENABLE 0x04
#define SSI_DATA 0x08
#define SSI_STATUS 0x0C
#define SSI_PRESCALER 0x10
enum { NOT_FULL = 0x02, CAME = 0x04, BUSY = 0x10 };
#define DC 7
#define CARD_SELECT 0

static void bus_on(void)
{
    SSI(SSI_PRESCALER) = 2; /* 4 MHz */
    SSI(SSI_FRAME) = 0x07;
    SSI(SSI_ENABLE) = 0x02;
}

/* Waits for what the status says, and reads away what comes in, which nobody wants and QEMU stops for; false if nothing
 * moves for longer than it can. The status is read behind the time: an emulator that was held up has missed nothing.
 */
static bool wait(uint32_t mask, uint32_t value)
{
    uint16_t since = pd_milliseconds;
    for (;;) {
        bool late = (uint16_t)(pd_milliseconds - since) > 20;
        uint32_t status = SSI(SSI_STATUS);
        if (status & CAME) {
            (void)SSI(SSI_DATA);
            since = pd_milliseconds;
            late = false;
        }
        if ((status & mask) == value)
            return true;
        if (late)
            return false;
    }
}

/* There is no acknowledgement: what a control byte says on I2C, the D/C line says here. */
static enum pd_fault write_all(void)
{
    bool control = false;
    for (;;) {
        uint16_t step = pd_bus_next();
        if (step > 0xFF) {
            if (!wait(BUSY | CAME, 0))
                return PD_BUS_STUCK;
            if (step == PD_STOP)
                return PD_OK;
            control = true;
        } else if (control) {
            PORT_C(PIN(DC)) = step == 0x40 ? 1 << DC : 0;
            control = false;
        } else {
            if (!wait(NOT_FULL, NOT_FULL))
                return PD_BUS_STUCK;
            SSI(SSI_DATA) = step;
        }
    }
}

void pd_port_bus_start(void)
{
    enum pd_fault fault = write_all();
    if (fault)
        bus_on();
    pd_bus_done(fault);
}

void pd_port_bus_abort(void) {}

void pd_port_reset_panel(void) {}

void pd_panel_init(void)
{
    PORT_A(ALTERNATE) = 0x2F; /* the UART's two pins as well */
    PORT_A(DIGITAL) = 0x2F;
    PORT_C(DIRECTION) |= 1 << DC;
    PORT_C(DIGITAL) |= 1 << DC;
    PORT_D(DIRECTION) |= 1 << CARD_SELECT;
    PORT_D(DIGITAL) |= 1 << CARD_SELECT;
    PORT_D(PIN(CARD_SELECT)) = 1 << CARD_SELECT;
    bus_on();
}
