/* The panel on the ATmega328P's TWI (I2C), written by interrupts. */
#include "board.h"

#include <avr/io.h>
#include <util/delay.h>
#include <util/twi.h>

#define TWI_HZ 400000UL
#define TWI_ON (_BV(TWINT) | _BV(TWEN) | _BV(TWIE))
#define SDA PC4
#define SCL PC5

/* The step after the one that is on the bus, so that the next interrupt can answer at once. A plain byte waits in
 * GPIOR1, and GPIOR0 says so: the bus stands still until the interrupt has answered, and this way that takes 20 cycles
 * instead of the 60 that saving all registers first would take.
 */
static uint16_t next_step;
static bool reading;
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

/* What is no byte that the panel took: the byte that it gives, or an end. */
static void other(uint8_t status)
{
    if (status == TW_MR_SLA_ACK) {
        TWCR = TWI_ON; /* its first byte is its last */
    } else if (status == TW_MR_DATA_NACK) {
        pd_bus_took(TWDR);
        bus_end(PD_OK);
    } else if (status == TW_MT_SLA_NACK || status == TW_MR_SLA_NACK) {
        bus_end(PD_ADDRESS_NACK);
    } else {
        bus_end(status == TW_MT_DATA_NACK ? PD_DATA_NACK : PD_BUS_STUCK);
    }
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
        TWDR = PD_ADDRESS << 1 | reading;
        TWCR = TWI_ON;
    } else if (status != TW_MT_DATA_ACK && status != TW_MT_SLA_ACK) {
        other(status);
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
    reading = pd_bus_next() == PD_READ; /* the first is this or PD_START */
    look_ahead();
    GPIOR0 = 0;
    PD_GUARDED(TWCR = TWI_ON | _BV(TWSTA)); /* not before the step is there */
}

void pd_panel_init(void)
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
    pd_panel_init();
}
