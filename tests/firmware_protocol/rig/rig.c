/* An ATmega328P that runs the real firmware: a test program on libsimavr (GPL), never part of what is shipped.
 *
 * simavr runs the instructions. Its UART, TWI and SPI are taken out and replaced by the ones below, written after the
 * part's datasheet, because simavr's keep other times, acknowledge an address with the status of a data byte, buffer
 * 64 characters where the part has two, and forget their timers at a reset. Bytes come and go with their cycle, so
 * that whoever drives this decides what time is: as fast as it runs, or paced by a clock.
 */
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <simavr/avr_eeprom.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_spi.h>
#include <simavr/avr_twi.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_core.h>
#include <simavr/sim_cycle_timers.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_interrupts.h>
#include <simavr/sim_io.h>
#include <simavr/sim_regbit.h>

#define QUEUE 65536
#define FIFO 3 /* two characters and the shift register */
enum { PORF = 1, EXTRF = 2, BORF = 4, WDRF = 8 };
enum { U2X = 0x02, DOR = 0x08, FE = 0x10, UDRE = 0x20, TXC = 0x40, RXC = 0x80 };
enum { TXEN = 0x08, RXEN = 0x10, UDRIE = 0x20 };
enum { TWEN = 0x04, TWEA = 0x40, TWSTO = 0x10, TWSTA = 0x20, TWINT = 0x80 };
enum { SPR = 0x03, CPHA = 0x04, CPOL = 0x08, MSTR = 0x10, DORD = 0x20, SPE = 0x40 };
enum { SPI2X = 0x01, WCOL = 0x40, SPIF = 0x80 };
/* Port B, as the SPI build has it. */
enum { PANEL_RESET = 0x01, DC = 0x02, CHIP_SELECT = 0x04, MOSI = 0x08, CLOCK = 0x20 };

struct character {
    uint64_t cycle;
    uint32_t bit; /* cycles a bit of whoever sent it */
    uint8_t byte;
};

struct queue {
    struct character items[QUEUE];
    uint32_t head, tail;
};

struct log {
    uint8_t *bytes;
    size_t size, room;
};

struct rig {
    avr_io_t io; /* first: simavr calls reset with it */
    avr_t *avr;
    avr_uart_t *uart;
    avr_twi_t *twi;
    avr_spi_t *spi;
    struct queue to_avr, from_avr;
    uint64_t line_free;
    uint8_t fifo[FIFO], fifo_status[FIFO], fifo_size;
    bool overrun, shifting, buffered, transmitted;
    uint8_t shift, buffer;
    bool open, addressed, reading;
    uint8_t twi_status, twi_byte, gives;
    bool absent, stuck;
    long nack_after;
    struct log log, wire;
    size_t transaction;
    uint64_t bus_cycle, panel_reset_cycle;
    uint32_t overruns;
    bool spi_sending, spi_seen;
    uint8_t spi_byte, pins;
    uint32_t spi_fastest, frame_cycles;
};

static uint8_t *reg(struct rig *rig, avr_io_addr_t at)
{
    return rig->avr->data + at;
}

/* -- UART */

static uint32_t bit_cycles(struct rig *rig)
{
    uint32_t divisor = *reg(rig, rig->uart->ubrrl.reg) | (*reg(rig, rig->uart->ubrrh.reg) & 15) << 8;
    return (divisor + 1) * (*reg(rig, rig->uart->r_ucsra) & U2X ? 8 : 16);
}

static void show_status(struct rig *rig)
{
    uint8_t *status = reg(rig, rig->uart->r_ucsra);
    *status &= U2X | 1;
    if (rig->fifo_size)
        *status |= RXC | rig->fifo_status[0];
    if (!rig->buffered)
        *status |= UDRE;
    if (rig->transmitted)
        *status |= TXC;
}

static void interrupt_if(struct rig *rig, bool due, avr_int_vector_t *vector)
{
    if (due && avr_regbit_get(rig->avr, vector->enable))
        avr_raise_interrupt(rig->avr, vector);
    show_status(rig);
}

static uint64_t arrive(avr_t *avr, uint64_t when, void *param)
{
    struct rig *rig = param;
    struct queue *queue = &rig->to_avr;
    while (queue->tail != queue->head && queue->items[queue->tail % QUEUE].cycle <= avr->cycle) {
        struct character *came = &queue->items[queue->tail++ % QUEUE];
        uint32_t ours = bit_cycles(rig), theirs = came->bit;
        if (!(*reg(rig, rig->uart->r_ucsrb) & RXEN))
            continue;
        if (rig->fifo_size == FIFO) {
            rig->overrun = true;
            rig->overruns++;
            continue;
        }
        bool broken = ours * 20 < theirs * 19 || ours * 20 > theirs * 21;
        rig->fifo[rig->fifo_size] = broken ? came->byte * 37 + 11 : came->byte;
        rig->fifo_status[rig->fifo_size++] = (broken ? FE : 0) | (rig->overrun ? DOR : 0);
        rig->overrun = false;
        interrupt_if(rig, true, &rig->uart->rxc);
    }
    (void)when;
    if (queue->tail == queue->head)
        return 0;
    uint64_t next = queue->items[queue->tail % QUEUE].cycle;
    return next > avr->cycle ? next : avr->cycle + 1;
}

static uint8_t read_data(avr_t *avr, avr_io_addr_t at, void *param)
{
    struct rig *rig = param;
    uint8_t byte = rig->fifo[0];
    (void)avr;
    (void)at;
    if (rig->fifo_size) {
        rig->fifo_size--;
        memmove(rig->fifo, rig->fifo + 1, FIFO - 1);
        memmove(rig->fifo_status, rig->fifo_status + 1, FIFO - 1);
    }
    interrupt_if(rig, rig->fifo_size, &rig->uart->rxc);
    return byte;
}

static uint8_t read_status(avr_t *avr, avr_io_addr_t at, void *param)
{
    show_status(param);
    return avr->data[at];
}

static uint64_t shifted(avr_t *avr, uint64_t when, void *param)
{
    struct rig *rig = param;
    struct queue *queue = &rig->from_avr;
    (void)when;
    queue->items[queue->head++ % QUEUE] = (struct character){avr->cycle, bit_cycles(rig), rig->shift};
    rig->shifting = rig->buffered;
    rig->transmitted = !rig->buffered;
    rig->shift = rig->buffer;
    rig->buffered = false;
    interrupt_if(rig, true, &rig->uart->udrc);
    return rig->shifting ? avr->cycle + 10 * bit_cycles(rig) : 0;
}

static void write_data(avr_t *avr, avr_io_addr_t at, uint8_t value, void *param)
{
    struct rig *rig = param;
    (void)at;
    if (!(*reg(rig, rig->uart->r_ucsrb) & TXEN))
        return;
    if (rig->shifting) {
        rig->buffer = value;
        rig->buffered = true;
    } else {
        rig->shift = value;
        rig->shifting = true;
        avr_cycle_timer_register(avr, 10 * bit_cycles(rig), shifted, rig);
    }
    interrupt_if(rig, !rig->buffered, &rig->uart->udrc);
}

static void write_status(avr_t *avr, avr_io_addr_t at, uint8_t value, void *param)
{
    struct rig *rig = param;
    if (value & TXC)
        rig->transmitted = false;
    avr->data[at] = (avr->data[at] & ~(U2X | 1)) | (value & (U2X | 1));
    show_status(rig);
}

static void write_control(avr_t *avr, avr_io_addr_t at, uint8_t value, void *param)
{
    struct rig *rig = param;
    avr->data[at] = value;
    if (!(value & RXEN))
        rig->fifo_size = 0;
    interrupt_if(rig, !rig->buffered, &rig->uart->udrc);
    interrupt_if(rig, rig->fifo_size, &rig->uart->rxc);
}

/* -- TWI: a log of transactions, each its length in two bytes and its bytes without the address */

static void note(struct log *log, uint8_t byte)
{
    if (log->size == log->room)
        log->bytes = realloc(log->bytes, log->room = 2 * log->room + 4096);
    log->bytes[log->size++] = byte;
}

static uint32_t twi_bit(struct rig *rig)
{
    return 16 + 2 * *reg(rig, rig->twi->r_twbr) * (1 << 2 * (*reg(rig, rig->twi->r_twsr) & 3));
}

static uint64_t twi_done(avr_t *avr, uint64_t when, void *param)
{
    struct rig *rig = param;
    uint8_t *status = reg(rig, rig->twi->r_twsr);
    (void)when;
    if (rig->twi_status == 0xF8) {
        *reg(rig, rig->twi->r_twcr) &= ~TWSTO;
        return 0;
    }
    *status = (*status & 3) | rig->twi_status;
    avr_raise_interrupt(avr, &rig->twi->twi);
    return 0;
}

static void twi_byte(struct rig *rig, bool acknowledges)
{
    uint8_t byte = *reg(rig, rig->twi->r_twdr);
    if (!rig->addressed) {
        bool ours = byte >> 1 == 0x3C && !rig->absent;
        rig->addressed = true;
        rig->reading = byte & 1;
        rig->twi_status = (rig->reading ? 0x40 : 0x18) + (ours ? 0 : 8);
        if (ours) {
            rig->transaction = rig->log.size;
            note(&rig->log, 0);
            note(&rig->log, 0);
        }
    } else if (rig->reading) {
        *reg(rig, rig->twi->r_twdr) = rig->gives;
        rig->twi_status = acknowledges ? 0x50 : 0x58;
    } else if (rig->absent || rig->nack_after == 0) {
        rig->twi_status = 0x30;
    } else {
        if (rig->nack_after > 0)
            rig->nack_after--;
        note(&rig->log, byte);
        uint8_t *length = rig->log.bytes + rig->transaction;
        if (!++length[0])
            length[1]++;
        rig->twi_status = 0x28;
    }
}

static void write_twi(avr_t *avr, avr_io_addr_t at, uint8_t value, void *param)
{
    struct rig *rig = param;
    bool go = value & TWINT;
    uint32_t bits = 1;
    avr->data[at] = (value & ~TWINT) | (go ? 0 : avr->data[at] & TWINT);
    if (!(value & TWEN)) {
        avr->data[at] &= ~TWINT;
        rig->open = false;
        rig->twi->twi.pending = 0;
        avr_cycle_timer_cancel(avr, twi_done, rig);
        return;
    }
    if (!go)
        return;
    rig->twi->twi.pending = 0;
    if (value & TWSTO) {
        rig->open = false;
        rig->bus_cycle = avr->cycle;
        rig->twi_status = 0xF8;
    } else if (value & TWSTA) {
        rig->twi_status = rig->open ? 0x10 : 0x08;
        rig->open = true;
        rig->addressed = false;
    } else {
        bits = 9;
        twi_byte(rig, value & TWEA);
    }
    if (!rig->stuck)
        avr_cycle_timer_register(avr, bits * twi_bit(rig), twi_done, rig);
}

static void write_twi_data(avr_t *avr, avr_io_addr_t at, uint8_t value, void *param)
{
    (void)param;
    avr->data[at] = value;
}

/* -- SPI and the panel's lines: a log of what a panel sees, each event a letter and a byte */

enum event {
    COMMAND = 'c', /* a byte with D/C low */
    DATA = 'd',    /* a byte with D/C high */
    DESELECT = '/',
    RESET = 'r',   /* the reset line is low again and has been for so many milliseconds */
    WRONG = '!',   /* a panel may have missed something, the byte says what */
};
enum { TORN = 't', COLLISION = 'c', NOT_SELECTED = 's', OTHER_MODE = 'm', NO_OUTPUT = 'o' };

static void see(struct rig *rig, enum event what, uint8_t byte)
{
    note(&rig->wire, what);
    note(&rig->wire, byte);
}

/* The lines as the panel has them; a pull-up holds those that nobody drives. */
static void look_at_pins(struct rig *rig)
{
    avr_t *avr = rig->avr;
    uint8_t pins = avr->data[0x25] | ~avr->data[0x24], changed = pins ^ rig->pins;
    rig->pins = pins;
    if (rig->spi_sending && changed & (DC | CHIP_SELECT))
        see(rig, WRONG, TORN);
    if (changed & pins & CHIP_SELECT)
        see(rig, DESELECT, 0);
    if (changed & pins & PANEL_RESET) {
        uint64_t low = (avr->cycle - rig->panel_reset_cycle) / 16000;
        see(rig, RESET, low > 255 ? 255 : low);
    } else if (changed & PANEL_RESET) {
        rig->panel_reset_cycle = avr->cycle;
    }
}

static void pin_changed(avr_irq_t *irq, uint32_t value, void *param)
{
    (void)irq;
    (void)value;
    look_at_pins(param);
}

static uint64_t spi_done(avr_t *avr, uint64_t when, void *param)
{
    struct rig *rig = param;
    (void)when;
    rig->spi_sending = false;
    *reg(rig, rig->spi->r_spsr) |= SPIF;
    see(rig, rig->pins & DC ? DATA : COMMAND, rig->spi_byte);
    avr_raise_interrupt(avr, &rig->spi->spi);
    return 0;
}

static uint8_t read_spi_status(avr_t *avr, avr_io_addr_t at, void *param)
{
    ((struct rig *)param)->spi_seen = avr->data[at] & (SPIF | WCOL);
    return avr->data[at];
}

static void write_spi_status(avr_t *avr, avr_io_addr_t at, uint8_t value, void *param)
{
    (void)param;
    avr->data[at] = (avr->data[at] & ~SPI2X) | (value & SPI2X);
}

static void write_spi(avr_t *avr, avr_io_addr_t at, uint8_t value, void *param)
{
    static const uint8_t dividers[] = {4, 16, 64, 128};
    struct rig *rig = param;
    uint8_t control = *reg(rig, rig->spi->r_spcr), *status = reg(rig, rig->spi->r_spsr);
    (void)at;
    if (rig->spi_sending) {
        *status |= WCOL;
        see(rig, WRONG, COLLISION);
        return;
    }
    if (rig->spi_seen)
        *status &= ~(SPIF | WCOL);
    rig->spi_seen = false;
    if (rig->stuck)
        *reg(rig, rig->spi->r_spcr) = control &= ~MSTR;
    if (!(control & SPE) || !(control & MSTR))
        return;
    if (control & (DORD | CPOL | CPHA))
        see(rig, WRONG, OTHER_MODE);
    if (~avr->data[0x24] & (DC | CHIP_SELECT | MOSI | CLOCK))
        see(rig, WRONG, NO_OUTPUT);
    if (rig->pins & CHIP_SELECT)
        see(rig, WRONG, NOT_SELECTED);
    uint32_t bit = dividers[control & SPR] / (*status & SPI2X ? 2 : 1);
    if (bit < rig->spi_fastest)
        rig->spi_fastest = bit;
    rig->spi_byte = value;
    rig->spi_sending = true;
    avr_cycle_timer_register(avr, 8 * bit, spi_done, rig);
}

/* -- the whole */

static void reset(avr_io_t *io)
{
    struct rig *rig = (struct rig *)io;
    rig->fifo_size = 0;
    rig->overrun = rig->shifting = rig->buffered = rig->transmitted = false;
    rig->open = rig->addressed = rig->spi_sending = rig->spi_seen = false;
    *reg(rig, rig->twi->r_twsr) = 0xF8;
    look_at_pins(rig);
    show_status(rig);
    if (rig->to_avr.tail != rig->to_avr.head)
        avr_cycle_timer_register(rig->avr, 1, arrive, rig);
}

static void entered(avr_irq_t *irq, uint32_t vector, void *param)
{
    (void)irq;
    if (vector)
        ((struct rig *)param)->avr->cycle += 4; /* what the part takes to enter an interrupt */
}

static void *module(avr_t *avr, const char *kind)
{
    for (avr_io_t *io = avr->io_port; io; io = io->next)
        if (!strcmp(io->kind, kind))
            return io;
    return NULL;
}

static void take_over(struct rig *rig, avr_io_addr_t at, avr_io_read_t read, avr_io_write_t write)
{
    avr_io_addr_t io = AVR_DATA_TO_IO(at);
    rig->avr->io[io].r.c = read;
    rig->avr->io[io].r.param = rig;
    rig->avr->io[io].w.c = write;
    rig->avr->io[io].w.param = rig;
}

static void silent(avr_t *avr, const int level, const char *format, va_list list)
{
    (void)avr;
    (void)level;
    (void)format;
    (void)list;
}

/* What RAM holds of whatever was there, and where `rig_untouched` looks for it. */
static void lose_ram(struct rig *rig)
{
    memset(rig->avr->data + 0x100, 0xA5, rig->avr->ramend + 1 - 0x100);
}

struct rig *rig_new(const char *elf)
{
    elf_firmware_t firmware = {0};
    struct rig *rig = calloc(1, sizeof *rig);
    avr_global_logger_set(silent);
    rig->avr = avr_make_mcu_by_name("atmega328p");
    if (!rig->avr || avr_init(rig->avr) || elf_read_firmware(elf, &firmware))
        return NULL;
    avr_load_firmware(rig->avr, &firmware);
    rig->avr->frequency = 16000000;
    rig->uart = module(rig->avr, "uart");
    rig->twi = module(rig->avr, "twi");
    rig->spi = module(rig->avr, "spi");
    rig->nack_after = -1;
    rig->pins = 0xFF;
    rig->spi_fastest = UINT32_MAX;
    take_over(rig, rig->uart->r_udr, read_data, write_data);
    take_over(rig, rig->uart->r_ucsra, read_status, write_status);
    take_over(rig, rig->uart->r_ucsrb, NULL, write_control);
    take_over(rig, rig->twi->r_twcr, NULL, write_twi);
    take_over(rig, rig->twi->r_twdr, NULL, write_twi_data);
    take_over(rig, rig->spi->r_spdr, NULL, write_spi);
    take_over(rig, rig->spi->r_spsr, read_spi_status, write_spi_status);
    for (int pin = 0; pin < 8; pin++)
        avr_irq_register_notify(
            avr_io_getirq(rig->avr, AVR_IOCTL_IOPORT_GETIRQ('B'), pin), pin_changed, rig);
    rig->io.kind = "rig";
    rig->io.reset = reset;
    avr_register_io(rig->avr, &rig->io);
    /* simavr calls the modules' resets newest first; ours has to come after theirs */
    rig->avr->io_port = rig->io.next;
    avr_io_t *last = rig->avr->io_port;
    while (last->next)
        last = last->next;
    last->next = &rig->io;
    rig->io.next = NULL;
    avr_irq_register_notify(rig->avr->interrupts.irq + AVR_INT_IRQ_RUNNING, entered, rig);
    reset(&rig->io);
    lose_ram(rig);
    return rig;
}

void rig_free(struct rig *rig)
{
    avr_terminate(rig->avr);
    free(rig->avr);
    free(rig->log.bytes);
    free(rig->wire.bytes);
    free(rig);
}

uint64_t rig_cycle(struct rig *rig)
{
    return rig->avr->cycle;
}

/* Runs to a cycle, or, if asked, until a character has gone out; false if the core has crashed. */
bool rig_run(struct rig *rig, uint64_t until, bool stop_at_output)
{
    while (rig->avr->cycle < until) {
        int state = avr_run(rig->avr);
        if (state == cpu_Crashed || state == cpu_Done)
            return false;
        if (stop_at_output && rig->from_avr.head != rig->from_avr.tail)
            break;
    }
    return true;
}

/* Sends characters, one after the other, each bit taking so many cycles. */
void rig_feed(struct rig *rig, const uint8_t *bytes, uint32_t size, uint32_t bit)
{
    bool idle = rig->to_avr.head == rig->to_avr.tail;
    if (rig->line_free < rig->avr->cycle)
        rig->line_free = rig->avr->cycle;
    for (uint32_t i = 0; i < size; i++) {
        rig->line_free += 10 * bit;
        rig->to_avr.items[rig->to_avr.head++ % QUEUE] = (struct character){rig->line_free, bit, bytes[i]};
    }
    if (idle && size)
        avr_cycle_timer_register(
            rig->avr, rig->to_avr.items[rig->to_avr.tail % QUEUE].cycle - rig->avr->cycle, arrive, rig);
}

/* Takes one character that went out; returns the cycles of its bits, 0 if there is none. */
uint32_t rig_take(struct rig *rig, uint8_t *byte)
{
    struct queue *queue = &rig->from_avr;
    if (queue->head == queue->tail)
        return 0;
    struct character *gone = &queue->items[queue->tail++ % QUEUE];
    *byte = gone->byte;
    return gone->bit;
}

static uint32_t take(struct log *log, size_t end, uint8_t *bytes, uint32_t room)
{
    if (end > room)
        return 0;
    memcpy(bytes, log->bytes, end);
    memmove(log->bytes, log->bytes + end, log->size - end);
    log->size -= end;
    return (uint32_t)end;
}

/* Takes what the panel's TWI carried; only whole transactions. */
uint32_t rig_log(struct rig *rig, uint8_t *bytes, uint32_t room)
{
    size_t end = rig->open && rig->addressed ? rig->transaction : rig->log.size;
    uint32_t taken = take(&rig->log, end, bytes, room);
    rig->transaction -= taken;
    return taken;
}

/* Takes what a panel on SPI has seen. */
uint32_t rig_wire(struct rig *rig, uint8_t *bytes, uint32_t room)
{
    return take(&rig->wire, rig->wire.size, bytes, room);
}

/* The fewest cycles that a bit on SPI has taken. */
uint32_t rig_spi_fastest(struct rig *rig)
{
    return rig->spi_fastest;
}

void rig_panel(struct rig *rig, bool absent, bool stuck, long nack_after)
{
    rig->absent = absent;
    rig->stuck = stuck;
    rig->nack_after = nack_after;
}

/* What the panel gives when it is read. */
void rig_gives(struct rig *rig, uint8_t byte)
{
    rig->gives = byte;
}

static uint64_t pulse(avr_t *avr, uint64_t when, void *param)
{
    struct rig *rig = param;
    avr_irq_t *line = avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('D'), 2);
    avr_raise_irq(line, 1);
    avr_raise_irq(line, 0);
    return rig->frame_cycles ? when + rig->frame_cycles : 0;
}

/* Lets the panel's frame line pulse every so many cycles, or no more. */
void rig_frames(struct rig *rig, uint32_t cycles)
{
    avr_cycle_timer_cancel(rig->avr, pulse, rig);
    rig->frame_cycles = cycles;
    if (cycles)
        avr_cycle_timer_register(rig->avr, cycles, pulse, rig);
}

/* Pulls the reset pin, or cuts the power. */
void rig_reset(struct rig *rig, bool power)
{
    avr_reset(rig->avr);
    if (power)
        lose_ram(rig);
    *reg(rig, rig->avr->reset_flags.porf.reg) |= power ? PORF : EXTRF;
}

/* Sends the core into an endless loop with interrupts off, as a fault in the firmware would. */
void rig_hang(struct rig *rig)
{
    rig->avr->flash[rig->avr->flashend - 1] = 0xFF; /* rjmp . */
    rig->avr->flash[rig->avr->flashend] = 0xCF;
    rig->avr->sreg[S_I] = 0;
    rig->avr->pc = rig->avr->flashend - 1;
}

void rig_eeprom(struct rig *rig, uint8_t *bytes)
{
    avr_eeprom_desc_t all = {bytes, 0, 1024};
    avr_ioctl(rig->avr, AVR_IOCTL_EEPROM_GET, &all);
}

/* Bytes of RAM below the deepest that the stack has reached, above the variables. */
uint32_t rig_untouched(struct rig *rig)
{
    uint32_t best = 0, now = 0;
    for (uint32_t at = 0x100; at <= rig->avr->ramend; at++) {
        now = rig->avr->data[at] == 0xA5 ? now + 1 : 0;
        best = now > best ? now : best;
    }
    return best;
}

uint32_t rig_overruns(struct rig *rig)
{
    return rig->overruns;
}
