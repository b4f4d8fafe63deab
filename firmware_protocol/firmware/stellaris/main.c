/* A Stellaris board's UART by interrupt and its system tick; the panel is in i2c.c or ssi.c. */
#include "board.h"

#define UART(offset) REG(0x4000C000 + (offset))
#define UART_DATA 0x00
#define UART_FLAGS 0x18
#define UART_DIVISOR 0x24
#define UART_FRACTION 0x28
#define UART_LINE 0x2C
#define UART_CONTROL 0x30
#define UART_MASK 0x38
#define UART_CLEAR 0x44
#define UART_IRQ 5
enum { BUSY = 0x08, RX_EMPTY = 0x10, TX_FULL = 0x20 };

#define TICK(offset) REG(0xE000E010 + (offset))
#define ENABLE_IRQ REG(0xE000E100)

volatile uint16_t pd_milliseconds;
static uint16_t boots __attribute__((section(".noinit")));
static bool sending;

/* -- line */

void uart_interrupt(void)
{
    UART(UART_CLEAR) = 0x7F0;
    while (!(UART(UART_FLAGS) & RX_EMPTY)) {
        uint32_t came = UART(UART_DATA);
        if (came & 0xF00)
            pd_line_error();
        if (!(came & 0x500)) /* framing error or break */
            pd_receive((uint8_t)came);
    }
}

void pd_port_transmit(void)
{
    sending = true;
}

static void transmit(void)
{
    uint8_t byte;
    while (sending && !(UART(UART_FLAGS) & TX_FULL)) {
        sending = pd_transmit(&byte);
        if (sending)
            UART(UART_DATA) = byte;
    }
}

bool pd_port_transmitted(void)
{
    return !sending && !(UART(UART_FLAGS) & BUSY);
}

void pd_port_set_rate(uint32_t rate)
{
    uint32_t divisor = (CLOCK * 4 + rate / 2) / rate; /* in 64ths */
    UART(UART_CONTROL) = 0;
    UART(UART_DIVISOR) = divisor >> 6;
    UART(UART_FRACTION) = divisor & 63;
    UART(UART_LINE) = 0x70; /* 8N1, FIFOs */
    UART(UART_MASK) = 0x7D0; /* received, not read for a while, errors */
    UART(UART_CONTROL) = 0x301;
}

uint16_t pd_port_ticks(void)
{
    uint32_t left;
    uint16_t now;
    do { /* the count turns over now and then */
        now = pd_milliseconds;
        left = TICK(8);
    } while (now != pd_milliseconds);
    return (uint16_t)(now * 250 + (CLOCK / 1000 - 1 - left) / (CLOCK / 250000));
}

/* -- the whole */

static void init(void)
{
    SYSCTL(CLOCK_CONFIG) = (SYSCTL(CLOCK_CONFIG) & ~0x3F1UL) | CRYSTAL << 6;
    SYSCTL(CLOCKS_0) = 1 << 3;
    SYSCTL(CLOCKS_1) = 1 << 12 | 1 << 4 | 1;
    SYSCTL(CLOCKS_2) = 0x0F;
    for (volatile int wait = 8; wait; wait--)
        ;
    PORT_A(ALTERNATE) = 0x03;
    PORT_A(DIGITAL) = 0x03;
    pd_panel_init();
    pd_port_set_rate(115200);
    ENABLE_IRQ = 1 << UART_IRQ;
    TICK(4) = CLOCK / 1000 - 1;
    TICK(0) = 7;
    WATCHDOG(WATCHDOG_LOAD) = CLOCK / 4;
    WATCHDOG(WATCHDOG_CONTROL) = 3;
}

int main(void)
{
    uint32_t cause = SYSCTL(RESET_CAUSE);
    SYSCTL(RESET_CAUSE) = 0;
    init();
    pd_start(++boots, (uint8_t)((cause & 0x0C) | (cause >> 1 & 1) | (cause << 1 & 2)));
    for (;;) {
        uint16_t now;
        PD_GUARDED(now = pd_milliseconds);
        pd_poll(now);
        transmit();
        WATCHDOG(WATCHDOG_CLEAR) = 1;
    }
}

static void tick(void)
{
    pd_milliseconds++;
}

static void stop(void)
{
    for (;;)
        ;
}

extern uint32_t stack_top, data_source, data_start, data_end, bss_start, bss_end;

void start(void)
{
    uint32_t *from = &data_source;
    for (uint32_t *to = &data_start; to < &data_end;)
        *to++ = *from++;
    for (uint32_t *to = &bss_start; to < &bss_end;)
        *to++ = 0;
    main();
}

typedef void (*handler)(void);
__attribute__((section(".vectors"), used)) static const handler vectors[16 + UART_IRQ + 1] = {
    (handler)&stack_top, start, stop, stop, stop, stop, stop, [15] = tick, [16 + UART_IRQ] = uart_interrupt,
};
