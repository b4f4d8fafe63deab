/* The ATmega328P's UART, TWI, clock and watchdog. */
#include "paneldraw.h"

#include <avr/eeprom.h>
#include <avr/io.h>
#include <avr/wdt.h>
#include <util/delay.h>
#include <util/twi.h>

#define TWI_HZ 400000UL
#define TWI_ON (_BV(TWINT) | _BV(TWEN) | _BV(TWIE))
#define RESET_PIN PB0 /* Uno D8 */
#define SDA PC4
#define SCL PC5

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

/* The step after the one that is on the bus, so that the next interrupt can answer at once. A plain byte waits in
 * GPIOR1, and GPIOR0 says so: the bus stands still until the interrupt has answered, and this way that takes 20 cycles
 * instead of the 60 that saving all registers first would take.
 */
static uint16_t next_step;
#define READY 0
#define SENT 1

static inline void look_ahead(void)
{
    next_step = pd_bus_next();
    GPIOR1 = (uint8_t)next_step;
    if (next_step < PD_START)
        GPIOR0 = _BV(READY);
}

ISR(TWI_vect, ISR_NAKED)
{
    __asm__ volatile("push r24\n\t"
                     "in r24, __SREG__\n\t"
                     "push r24\n\t"
                     "sbis %[flags], %[ready]\n\t"
                     "rjmp 1f\n\t"
                     "lds r24, %[status]\n\t"
                     "andi r24, 0xF8\n\t"
                     "cpi r24, %[acknowledged]\n\t"
                     "brne 1f\n\t"
                     "in r24, %[byte]\n\t"
                     "sts %[data], r24\n\t"
                     "ldi r24, %[on]\n\t"
                     "sts %[control], r24\n\t"
                     "sbi %[flags], %[sent]\n\t"
                     "1: pop r24\n\t"
                     "out __SREG__, r24\n\t"
                     "pop r24\n\t"
                     "jmp __vector_panel\n\t"
                     :
                     : [flags] "I"(_SFR_IO_ADDR(GPIOR0)), [ready] "I"(READY), [sent] "I"(SENT),
                       [byte] "I"(_SFR_IO_ADDR(GPIOR1)), [status] "n"(_SFR_MEM_ADDR(TWSR)),
                       [data] "n"(_SFR_MEM_ADDR(TWDR)), [control] "n"(_SFR_MEM_ADDR(TWCR)),
                       [acknowledged] "M"(TW_MT_DATA_ACK), [on] "M"(TWI_ON));
}

static void bus_end(enum pd_fault fault)
{
    TWCR = _BV(TWINT) | _BV(TWEN) | _BV(TWSTO);
    pd_bus_done(fault);
}

void __vector_panel(void) __attribute__((signal, used, externally_visible));
void __vector_panel(void)
{
    uint8_t sent = GPIOR0 & _BV(SENT);
    uint8_t status = TW_STATUS;
    uint16_t step = next_step;
    GPIOR0 = 0;
    if (sent) {
        look_ahead();
    } else if (status == TW_START || status == TW_REP_START) {
        TWDR = PD_ADDRESS << 1;
        TWCR = TWI_ON;
    } else if (status != TW_MT_DATA_ACK && status != TW_MT_SLA_ACK) {
        bus_end(status == TW_MT_SLA_NACK ? PD_ADDRESS_NACK : status == TW_MT_DATA_NACK ? PD_DATA_NACK : PD_BUS_STUCK);
    } else if (step < PD_START) {
        TWDR = (uint8_t)step;
        TWCR = TWI_ON;
        look_ahead();
    } else if (step == PD_START) {
        TWCR = TWI_ON | _BV(TWSTA);
        look_ahead();
        GPIOR0 = 0; /* it waits for the address */
    } else {
        bus_end(PD_OK);
    }
}

void pd_port_bus_start(void)
{
    for (uint8_t patience = 255; TWCR & _BV(TWSTO) && patience; patience--)
        ;
    pd_bus_next(); /* the first is PD_START */
    look_ahead();
    GPIOR0 = 0;
    PD_GUARDED(TWCR = TWI_ON | _BV(TWSTA)); /* not before the step is there */
}

static void bus_on(void)
{
    PORTC |= _BV(SDA) | _BV(SCL); /* weak pull-ups, where the module has none */
    TWSR = 0;
    TWBR = (F_CPU / TWI_HZ - 16) / 2;
    TWCR = _BV(TWEN);
}

/* Clocks out whatever a panel that lost its place still holds the line with. */
void pd_port_bus_abort(void)
{
    TWCR = 0;
    PORTC &= ~_BV(SCL);
    for (uint8_t clocks = 9; clocks && !(PINC & _BV(SDA)); clocks--) {
        DDRC |= _BV(SCL);
        _delay_us(5);
        DDRC &= ~_BV(SCL);
        _delay_us(5);
    }
    bus_on();
}

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
    PORTB |= _BV(RESET_PIN);
    DDRB |= _BV(RESET_PIN);
    TCCR0A = _BV(WGM01);
    TCCR0B = _BV(CS01) | _BV(CS00); /* F_CPU / 64 */
    OCR0A = F_CPU / 64 / 1000 - 1;
    TIMSK0 = _BV(OCIE0A);
    bus_on();
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
