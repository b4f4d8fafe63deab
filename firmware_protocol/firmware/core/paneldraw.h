/* The device's end of the serial link (../../PROTOCOL.md): portable, no allocation, no hardware.
 *
 * A port supplies port.h (sizes, what the device says of itself, how to keep interrupts out) and the functions named
 * pd_port_*. It calls pd_start once, pd_poll for ever from its main loop, and the rest from its interrupts.
 */
#ifndef PANELDRAW_H
#define PANELDRAW_H

#include <stdbool.h>
#include <stdint.h>

#define PD_BUS_IS_I2C 1
#define PD_BUS_IS_SPI 2
#include "port.h"

#define PD_RING_MASK (PD_RING_SIZE - 1)
/* What may come beside the host's credits: POLLs of 7 bytes each, HELLO, READ and delimiters. */
#define PD_RESERVE 64
#define PD_WINDOW (PD_RING_SIZE - PD_RESERVE)
/* What a frame holds besides its payload: kind, seq, checksum, the delimiter, and one byte of COBS and more. */
#define PD_FRAME_OVERHEAD (6 + (PD_MAX_PAYLOAD + 3) / 254)
/* Whether repeats are understood; whether the panel's bus can read a byte from the panel. */
#ifndef PD_REPEATS
#define PD_REPEATS 1
#endif
#ifndef PD_READS
#define PD_READS 0
#endif
/* Bytes of sub-pictures that are kept and written in turn; whether the panel's frame line is wired, see pd_frame. */
#ifndef PD_STORE_SIZE
#define PD_STORE_SIZE 0
#endif
#ifndef PD_FRAME_LINE
#define PD_FRAME_LINE 0
#endif

#if PD_RING_SIZE < 1 || PD_RING_SIZE & (PD_RING_SIZE - 1) || PD_RING_SIZE > 65536
#error "PD_RING_SIZE must be a power of two up to 65536: places in it are 16 bits"
#endif
#if PD_MAX_PAYLOAD < 32 || PD_MAX_PAYLOAD > 1024
#error "PD_MAX_PAYLOAD must be 32 to 1024: a host sends no less, and more keeps the panel waiting"
#endif
#if PD_MAX_PAYLOAD + PD_FRAME_OVERHEAD > PD_WINDOW
#error "PD_RING_SIZE must hold a frame of PD_MAX_PAYLOAD and what comes beside the window"
#endif
#if PD_TX_SIZE < 1 || PD_TX_SIZE & (PD_TX_SIZE - 1) || PD_TX_SIZE > 128
#error "PD_TX_SIZE must be a power of two up to 128: places in it are 8 bits"
#endif
#if PD_BUS != PD_BUS_IS_I2C && PD_BUS != PD_BUS_IS_SPI
#error "PD_BUS must be PD_BUS_IS_I2C or PD_BUS_IS_SPI"
#endif
#if PD_STORE_SIZE < 0 || PD_STORE_SIZE > 32767
#error "PD_STORE_SIZE must be 0 to 32767"
#endif
#if PD_BUS == PD_BUS_IS_SPI && PD_CONTROL_EACH
#error "PD_CONTROL_EACH must be 0 on SPI, where there are no control bytes"
#endif

/* The versions of the protocol that this is. */
#ifndef PD_OLDEST_VERSION
#define PD_OLDEST_VERSION 1
#define PD_NEWEST_VERSION 1
#endif

enum pd_fault {
    PD_OK,
    PD_ADDRESS_NACK,
    PD_DATA_NACK,
    PD_BUS_STUCK,
    PD_MALFORMED,
    PD_UNKNOWN_KIND,
    PD_BAUD_NOT_OFFERED,
};

/* Bytes from the line. A frame is decoded where it lies, and lies there until its last byte is on the panel's bus. */
struct pd_receiver {
    uint8_t ring[PD_RING_SIZE];
    volatile uint16_t head; /* written by the interrupt */
    volatile uint16_t tail; /* written by pd_poll */
    volatile uint16_t overflows;
    volatile uint16_t line_errors;
};
extern struct pd_receiver pd_rx;

/* Call with each byte that the line brings. */
static inline void pd_receive(uint8_t byte)
{
    uint16_t at = pd_rx.head;
    uint16_t next = (at + 1) & PD_RING_MASK;
    if (next == pd_rx.tail) {
        pd_rx.overflows++;
        return;
    }
    pd_rx.ring[at] = byte;
    pd_rx.head = next;
}

/* Call for each byte that came broken or was overrun. */
static inline void pd_line_error(void)
{
    pd_rx.line_errors++;
}

void pd_start(uint16_t boot, uint8_t cause);
void pd_poll(uint16_t milliseconds);

/* The next byte for the line; false if there is none. */
bool pd_transmit(uint8_t *byte);

/* What the panel's bus has to do next: a byte (00 to FF), or one of these. */
#define PD_START 0x100 /* end the transaction if there is one, begin another: start, address, write */
#define PD_STOP 0x200  /* end the transaction and call pd_bus_done */
#define PD_READ 0x300  /* with PD_READS alone: start, address, read, a byte for pd_bus_took; then comes PD_STOP */
uint16_t pd_bus_next(void);
void pd_bus_took(uint8_t byte);
void pd_bus_done(enum pd_fault fault);

#if PD_FRAME_LINE
/* Call with each pulse of the panel's frame line. */
void pd_frame(void);
#endif

/* The time in ticks of 4 microseconds. */
uint16_t pd_port_ticks(void);

/* Begin to do what pd_bus_next says, in the background or at once. */
void pd_port_bus_start(void);
/* Give up what the bus does, free it, and forget it; pd_bus_done is not called. */
void pd_port_bus_abort(void);
/* There are bytes to transmit. */
void pd_port_transmit(void);
/* Whether the last bit of all that was transmitted is out. */
bool pd_port_transmitted(void);
void pd_port_set_rate(uint32_t rate);
void pd_port_reset_panel(void);

#endif
