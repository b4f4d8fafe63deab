/* The panel on the ATmega328P's SPI, written by waiting: a byte is out sooner than an interrupt would have begun. */
#include "board.h"

#include <avr/io.h>

#define DC PB1            /* Uno D9 */
#define CHIP_SELECT PB2   /* D10; an output, or the SPI would not stay a master */
#define MOSI PB3          /* D11 */
#define CLOCK PB5         /* D13 */
#define BYTE_PATIENCE 64 /* looks at a byte that takes 32 cycles */

/* Mode 0, highest bit first, F_CPU / 4: the 4 MHz that a PCD8544 bears. */
static void bus_on(void)
{
    SPCR = _BV(SPE) | _BV(MSTR);
    SPSR = 0;
}

static bool is_out(void)
{
    for (uint8_t patience = BYTE_PATIENCE; patience; patience--)
        if (SPSR & _BV(SPIF))
            return true;
    return false;
}

/* There is no acknowledgement: what a control byte says on I2C, the D/C line says here. The next byte is fetched while
 * one is on its way. The longest frame, 125 repeats of 65, takes 40 ms.
 */
void pd_port_bus_start(void)
{
    bool control = false, sending = false;
    enum pd_fault fault = PD_OK;
    for (;;) {
        uint16_t step = pd_bus_next();
        if (sending && !is_out()) {
            fault = PD_BUS_STUCK;
            bus_on();
            break;
        }
        sending = false;
        if (step == PD_STOP) {
            break;
        } else if (step == PD_START) {
            PORTB |= _BV(CHIP_SELECT);
            control = true;
        } else if (control) {
            if (step == 0x40)
                PORTB |= _BV(DC);
            else
                PORTB &= ~_BV(DC);
            PORTB &= ~_BV(CHIP_SELECT);
            control = false;
        } else {
            SPDR = (uint8_t)step;
            sending = true;
        }
    }
    PORTB |= _BV(CHIP_SELECT);
    pd_bus_done(fault);
}

void pd_port_bus_abort(void) {}

void pd_panel_init(void)
{
    PORTB |= _BV(CHIP_SELECT);
    DDRB |= _BV(DC) | _BV(CHIP_SELECT) | _BV(MOSI) | _BV(CLOCK);
    bus_on();
}
