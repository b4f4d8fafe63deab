/* The panel on I2C0, written and read by waiting. */
#include "board.h"

#define I2C(offset) REG(0x40020000 + (offset))
#define I2C_ADDRESS 0x00
#define I2C_STATUS 0x04
#define I2C_DATA 0x08
#define I2C_PERIOD 0x0C
#define I2C_CONTROL 0x20
enum { RUN = 1, START = 2, STOP = 4 };
enum { I2C_BUSY = 0x01, I2C_ERROR = 0x02, NO_DATA_ACK = 0x08, LOST = 0x10 };

/* Tells the controller what to do and waits; what went wrong, if something did. A frame of repeats takes long, so each
 * byte is a sign of life.
 */
static enum pd_fault command(uint32_t what)
{
    uint32_t status;
    bool late;
    uint16_t since = pd_milliseconds;
    WATCHDOG(WATCHDOG_CLEAR) = 1;
    I2C(I2C_STATUS) = what;
    do {
        late = (uint16_t)(pd_milliseconds - since) > 20; /* before the status, which may have come right meanwhile */
        status = I2C(I2C_STATUS);
    } while (status & I2C_BUSY && !late);
    if (status & I2C_BUSY)
        return PD_BUS_STUCK;
    if (!(status & I2C_ERROR))
        return PD_OK;
    I2C(I2C_STATUS) = STOP;
    return status & NO_DATA_ACK ? PD_DATA_NACK : PD_ADDRESS_NACK;
}

/* One byte, which is not acknowledged, as it is the last. */
static enum pd_fault read_one(void)
{
    I2C(I2C_ADDRESS) = PD_ADDRESS << 1 | 1;
    enum pd_fault fault = command(RUN | START | STOP);
    if (!fault)
        pd_bus_took((uint8_t)I2C(I2C_DATA));
    return fault;
}

/* The controller sends the address with the first byte. Between transactions there is a stop, because QEMU's panel
 * begins to listen for control bytes again only then.
 */
static enum pd_fault write_all(void)
{
    uint32_t start = 0;
    bool open = false;
    enum pd_fault fault = PD_OK;
    for (;;) {
        uint16_t step = pd_bus_next();
        if (step == PD_READ)
            return read_one();
        if (step <= 0xFF) {
            I2C(I2C_DATA) = step;
            fault = command(RUN | start);
            start = 0;
            open = true;
        } else {
            if (start) /* nothing but the address: is anybody there? */
                fault = command(START | STOP);
            else if (open)
                fault = command(STOP);
            open = false;
            start = START;
            if (step == PD_STOP)
                return fault;
        }
        if (fault)
            return fault;
    }
}

void pd_port_bus_start(void)
{
    I2C(I2C_ADDRESS) = PD_ADDRESS << 1;
    pd_bus_done(write_all());
}

void pd_port_bus_abort(void) {}

void pd_port_reset_panel(void) {}

void pd_panel_init(void)
{
    PORT_B(ALTERNATE) = 0x0C;
    PORT_B(DIGITAL) = 0x0C;
    PORT_B(OPEN_DRAIN) = 0x0C;
    I2C(I2C_CONTROL) = 0x10;
    I2C(I2C_PERIOD) = 0; /* 6 MHz / 20 = 300 kHz */
}
