/* The ATmega328P's UART, clock and watchdog; the panel is in twi.c or spi.c. */
#include "board.h"

#include <avr/eeprom.h>
#include <avr/io.h>
#include <avr/wdt.h>
#include <util/delay.h>

#define RESET_PIN PB0 /* Uno D8 */
#define TICKS (F_CPU / 64 / 1000) /* of 4 us, a millisecond */

static volatile uint16_t milliseconds;
static uint8_t cause __attribute__((section(".noinit")));
/* The number of this start. Its upper half counts in the EEPROM how often RAM has lost the lower one: a loop of resets
 * wears out nothing.
 */
static uint16_t boot __attribute__((section(".noinit")));
static uint16_t boot_inverted __attribute__((section(".noinit")));
static uint8_t power_ons EEMEM;

/* A watchdog that has fired stays on, at its shortest; this runs before anything takes long. */
void pd_early(void) __attribute__((naked, used, section(".init3")));
void pd_early(void)
{
    cause = MCUSR;
    MCUSR = 0;
    wdt_disable();
}

/* -- line */

ISR(USART_RX_vect)
{
    uint8_t status = UCSR0A;
    uint8_t byte = UDR0;
    if (status & (_BV(FE0) | _BV(DOR0))) {
        pd_line_error();
        if (status & _BV(FE0))
            return;
    }
    pd_receive(byte);
}

ISR(USART_UDRE_vect)
{
    uint8_t byte;
    if (pd_transmit(&byte)) {
        UCSR0A = _BV(U2X0) | _BV(TXC0); /* writing the flag clears it */
        UDR0 = byte;
    } else {
        UCSR0B &= ~_BV(UDRIE0);
    }
}

void pd_port_transmit(void)
{
    PD_GUARDED(UCSR0B |= _BV(UDRIE0));
}

bool pd_port_transmitted(void)
{
    return !(UCSR0B & _BV(UDRIE0)) && UCSR0A & _BV(TXC0);
}

void pd_port_set_rate(uint32_t rate)
{
    UBRR0 = (F_CPU / 8 + rate / 2) / rate - 1;
    UCSR0A = _BV(U2X0);
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(RXCIE0) | _BV(RXEN0) | _BV(TXEN0);
}

/* -- panel */

void pd_port_reset_panel(void)
{
    PORTB &= ~_BV(RESET_PIN);
    _delay_ms(10);
    PORTB |= _BV(RESET_PIN);
    _delay_ms(10);
}

#if PD_FRAME_LINE
ISR(INT0_vect)
{
    pd_frame();
}
#endif

/* -- time */

ISR(TIMER0_COMPA_vect)
{
    milliseconds++;
}

/* What an interrupt that waits would count is counted here. */
uint16_t pd_port_ticks(void)
{
    uint16_t ticks;
    PD_GUARDED({
        uint8_t part = TCNT0;
        ticks = milliseconds;
        if (TIFR0 & _BV(OCF0A)) {
            part = TCNT0;
            ticks++;
        }
        ticks = ticks * TICKS + part;
    });
    return ticks;
}

static void count_boot(void)
{
    if (boot == (uint16_t)~boot_inverted) {
        boot = (boot & 0xFF00) | (uint8_t)(boot + 1);
    } else {
        boot = (uint16_t)(eeprom_read_byte(&power_ons) + 1) << 8;
        eeprom_update_byte(&power_ons, boot >> 8);
    }
    boot_inverted = ~boot;
}

int main(void)
{
    DDRB |= _BV(RESET_PIN);
    pd_panel_init();
#if PD_FRAME_LINE /* Uno D2 */
    EICRA = _BV(ISC01) | _BV(ISC00);
    EIMSK = _BV(INT0);
#endif
    TCCR0A = _BV(WGM01);
    TCCR0B = _BV(CS01) | _BV(CS00); /* F_CPU / 64 */
    OCR0A = TICKS - 1;
    TIMSK0 = _BV(OCIE0A);
    pd_port_set_rate(115200);
    count_boot();
    pd_start(boot, cause & 0x0F);
    wdt_enable(WDTO_500MS);
    sei();
    for (;;) {
        uint16_t now;
        PD_GUARDED(now = milliseconds);
        pd_poll(now);
        wdt_reset();
    }
}
