/* The bytes for the line: frames, encoded as they are written. */
#include "out.h"

static struct {
    uint8_t ring[PD_TX_SIZE];
    volatile uint8_t head, tail;
    uint8_t at, code, block; /* the frame that is being written */
    uint16_t crc;
} out;

void out_byte(uint8_t byte)
{
    out.crc = pd_crc(out.crc, byte);
    if (byte) {
        out.ring[out.at & (PD_TX_SIZE - 1)] = byte;
        out.block++;
    } else {
        out.ring[out.code & (PD_TX_SIZE - 1)] = out.block;
        out.code = out.at;
        out.block = 1;
    }
    out.at++;
}

void out_put(uint16_t value, uint8_t bytes)
{
    for (; bytes; bytes--, value >>= 8)
        out_byte((uint8_t)value);
}

static void begin(uint8_t at, uint8_t kind, uint8_t seq)
{
    out.code = at;
    out.at = out.code + 1;
    out.block = 1;
    out.crc = 0xFFFF;
    out_byte(kind);
    out_byte(seq);
}

void out_begin(uint8_t kind, uint8_t seq)
{
    begin(out.head, kind, seq);
}

void out_begin_apart(uint8_t kind, uint8_t seq)
{
    out.ring[out.head & (PD_TX_SIZE - 1)] = 0;
    begin(out.head + 1, kind, seq);
}

void out_finish(void)
{
    uint16_t crc = out.crc;
    out_byte(crc >> 8);
    out_byte((uint8_t)crc);
    out.ring[out.code & (PD_TX_SIZE - 1)] = out.block;
    out.ring[out.at & (PD_TX_SIZE - 1)] = 0;
    PD_GUARDED(out.head = out.at + 1); /* not before the bytes are there */
    pd_port_transmit();
}

bool pd_transmit(uint8_t *byte)
{
    uint8_t tail = out.tail;
    if (tail == out.head)
        return false;
    *byte = out.ring[tail & (PD_TX_SIZE - 1)];
    out.tail = tail + 1;
    return true;
}

uint8_t out_room(void)
{
    return PD_TX_SIZE - (uint8_t)(out.head - out.tail);
}

void out_clear(void)
{
    out.head = out.tail = 0;
}
