/* The bytes from the line: frames, decoded where they lie. */
#include "in.h"

#define BURST 48 /* bytes that are decoded at a time */

struct in in;

void in_begin(void)
{
    in.start = in.end = in.read;
    in.length = 0;
    in.crc = 0xFFFF;
    in.block = in.left = 0;
    in.damaged = false;
}

void in_skip(void)
{
    PD_GUARDED(in.read = pd_rx.head);
    in_begin();
}

static void keep(uint8_t byte)
{
    if (in.length == PD_MAX_PAYLOAD + IN_ENVELOPE) {
        in.damaged = true;
        return;
    }
    in.length++;
    in.crc = pd_crc(in.crc, byte);
    pd_rx.ring[in.end] = byte;
    in.end = (in.end + 1) & PD_RING_MASK;
}

/* Keeps bytes of the block that is open, at most so many; returns how many. It is here that most of the time goes. */
static uint8_t keep_block(uint16_t head, uint8_t most)
{
    uint16_t read = in.read, end = in.end, crc = in.crc;
    uint16_t room = PD_MAX_PAYLOAD + IN_ENVELOPE - in.length;
    uint8_t kept = 0;
    if (most > in.left)
        most = in.left;
    if (most > room)
        most = (uint8_t)room;
    while (kept != most && read != head) {
        uint8_t byte = pd_rx.ring[read];
        if (!byte)
            break;
        crc = pd_crc(crc, byte);
        pd_rx.ring[end] = byte;
        read = (read + 1) & PD_RING_MASK;
        end = (end + 1) & PD_RING_MASK;
        kept++;
    }
    in.read = read;
    in.end = end;
    in.crc = crc;
    in.left -= kept;
    in.length += kept;
    return kept;
}

static enum in_event end_frame(void)
{
    if (in.damaged || in.left || (in.block && (in.length < IN_ENVELOPE || in.crc)))
        return IN_DAMAGED;
    if (in.block)
        return IN_FRAME;
    in_begin(); /* an empty frame is nothing */
    return IN_PART;
}

enum in_event in_decode(void)
{
    uint16_t head;
    PD_GUARDED(head = pd_rx.head);
    if (in.read == head)
        return IN_IDLE;
    for (uint8_t burst = BURST; burst && in.read != head; burst--) {
        if (!in.damaged) {
            burst -= keep_block(head, burst - 1);
            if (in.read == head)
                break;
        }
        uint8_t byte = pd_rx.ring[in.read];
        in.read = (in.read + 1) & PD_RING_MASK;
        if (!byte)
            return end_frame();
        if (in.damaged) {
            in.start = in.end = in.read; /* nothing of it is wanted */
        } else if (in.left) {
            in.left--;
            keep(byte);
        } else {
            if (in.block && in.block != 0xFF)
                keep(0);
            in.block = byte;
            in.left = byte - 1;
        }
    }
    return IN_PART;
}
