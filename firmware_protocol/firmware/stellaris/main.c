/* The LM3S811's UART by interrupt, its I2C by waiting, its system tick. Runs from the 6 MHz crystal, as after a reset. */
#include "paneldraw.h"

#define CLOCK 6000000UL
#define REG(address) (*(volatile uint32_t *)(address))

#define SYSCTL(offset) REG(0x400FE000 + (offset))
#define RESET_CAUSE 0x05C
#define CLOCKS_1 0x104 /* bit 0 UART0, bit 12 I2C0 */
#define CLOCKS_2 0x108 /* bit 0 port A, bit 1 port B */

#define PORT_A(offset) REG(0x40004000 + (offset))
#define PORT_B(offset) REG(0x40005000 + (offset))
#define ALTERNATE 0x420
#define OPEN_DRAIN 0x50C
#define DIGITAL 0x51C

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

#define I2C(offset) REG(0x40020000 + (offset))
#define I2C_ADDRESS 0x00
#define I2C_STATUS 0x04
#define I2C_DATA 0x08
#define I2C_PERIOD 0x0C
#define I2C_CONTROL 0x20
enum { RUN = 1, START = 2, STOP = 4 };
enum { I2C_BUSY = 0x01, I2C_ERROR = 0x02, NO_DATA_ACK = 0x08, LOST = 0x10 };

#define TICK(offset) REG(0xE000E010 + (offset))
#define ENABLE_IRQ REG(0xE000E100)

static volatile uint16_t milliseconds;
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

/* -- panel */

/* Tells the controller what to do and waits; what went wrong, if something did. */
static enum pd_fault command(uint32_t what)
{
    uint32_t status;
    uint16_t since = milliseconds;
    I2C(I2C_STATUS) = what;
    do {
        if ((uint16_t)(milliseconds - since) > 20)
            return PD_BUS_STUCK;
        status = I2C(I2C_STATUS);
    } while (status & I2C_BUSY);
    if (!(status & I2C_ERROR))
        return PD_OK;
    I2C(I2C_STATUS) = STOP;
    return status & NO_DATA_ACK ? PD_DATA_NACK : PD_ADDRESS_NACK;
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

/* -- the whole */

static void init(void)
{
    SYSCTL(CLOCKS_1) = 1 << 12 | 1;
    SYSCTL(CLOCKS_2) = 3;
    for (volatile int wait = 8; wait; wait--)
        ;
    PORT_A(ALTERNATE) = 0x03;
    PORT_A(DIGITAL) = 0x03;
    PORT_B(ALTERNATE) = 0x0C;
    PORT_B(DIGITAL) = 0x0C;
    PORT_B(OPEN_DRAIN) = 0x0C;
    I2C(I2C_CONTROL) = 0x10;
    I2C(I2C_PERIOD) = 0; /* 6 MHz / 20 = 300 kHz */
    pd_port_set_rate(115200);
    ENABLE_IRQ = 1 << UART_IRQ;
    TICK(4) = CLOCK / 1000 - 1;
    TICK(0) = 7;
}

int main(void)
{
    uint32_t cause = SYSCTL(RESET_CAUSE);
    SYSCTL(RESET_CAUSE) = 0;
    init();
    pd_start(++boots, (uint8_t)((cause & 0x0C) | (cause >> 1 & 1) | (cause << 1 & 2)));
    for (;;) {
        uint16_t now;
        PD_GUARDED(now = milliseconds);
        pd_poll(now);
        transmit();
    }
}

static void tick(void)
{
    milliseconds++;
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
