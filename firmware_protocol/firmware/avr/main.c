/* The ATmega328P's UART, clock and watchdog; the panel is in twi.c or spi.c. */
#include "board.h"

#include <avr/eeprom.h>
#include <avr/io.h>
#include <avr/wdt.h>
#include <util/delay.h>

#define RESET_PIN PB0 /* Uno D8 */

static volatile uint16_t milliseconds;
static uint8_t cause __attribute__((section(".noinit")));
static uint16_t boot_count EEMEM;

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

/* -- time */

ISR(TIMER0_COMPA_vect)
{
    milliseconds++;
}

static uint16_t count_boot(void)
{
    uint16_t boot = eeprom_read_word(&boot_count) + 1;
    eeprom_update_word(&boot_count, boot);
    return boot;
}

int main(void)
{
    DDRB |= _BV(RESET_PIN);
    pd_panel_init();
    pd_port_reset_panel();
    TCCR0A = _BV(WGM01);
    TCCR0B = _BV(CS01) | _BV(CS00); /* F_CPU / 64 */
    OCR0A = F_CPU / 64 / 1000 - 1;
    TIMSK0 = _BV(OCIE0A);
    pd_port_set_rate(115200);
    pd_start(count_boot(), cause & 0x0F);
    wdt_enable(WDTO_500MS);
    sei();
    for (;;) {
        uint16_t now;
        PD_GUARDED(now = milliseconds);
        pd_poll(now);
        wdt_reset();
    }
}
