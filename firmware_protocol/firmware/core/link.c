/* The state machine: frames in, work in order, replies out. */
#include "bus.h"
#include "cycle.h"
#include "in.h"
#include "out.h"

#define BASE_RATE 115200UL
#define PROBATION_MS 300
#define DOUBT_MS 1500
#define QUIET_MS 1000
#define BUS_PATIENCE_MS 25

enum kind {
    HELLO = 0x01,
    POLL = 0x02,
    READ = 0x03,
    WRITE = 0x10,
    WRITE_END = 0x11,
    BAUD = 0x12,
    RESET = 0x13,
    STORE = 0x14,
    CYCLE = 0x15,
    HELLO_REPLY = 0x81,
    STATUS = 0x82,
    BOOT = 0x83,
    ACK = 0x84,
    NAK = 0x85,
    BYTE = 0x86,
    TURN = 0xFE, /* no message: the next sub-picture */
    LOOK = 0xFF, /* no message: whether the panel is still there */
};

enum feature { WATCH = 1, READS = 2, CYCLES = 4 };
#define FEATURES ((PD_BUS == PD_BUS_IS_I2C ? WATCH : 0) | (PD_READS ? READS : 0) | (PD_STORE_SIZE ? CYCLES : 0))

enum owed { OWE_ACK = 1, OWE_NAK = 2, OWE_STATUS = 4, OWE_HELLO = 8, OWE_BOOT = 16, OWE_BYTE = 32 };

struct frame {
    uint8_t kind; /* 0 for none */
    uint8_t seq;
    uint16_t start, payload, end; /* in the ring */
};

struct pd_receiver pd_rx;

static struct {
    struct frame running, ready;
    uint8_t owed, expected, done, fault, version, token, reason, cause, features;
    uint8_t read_token, read_fault, read_value;
    bool armed, present, fast, doubtful; /* fast: at another rate than the first */
    uint16_t boot, damaged, line_errors, revert_at, bus_until, quiet_since;
    uint8_t bus_steps;
    uint32_t next_rate;
    uint8_t nonce[4];
} link;

static const uint32_t rates[] PD_FLASH = PD_RATES;
static const char controller[] PD_FLASH = PD_CONTROLLER;
static const char firmware[] PD_FLASH = PD_FIRMWARE;
#define RATES (sizeof rates / sizeof rates[0])
/* The longest reply is written whole before it goes out. */
typedef char hello_reply_fits[34 + 4 * RATES + sizeof controller + sizeof firmware <= PD_TX_SIZE ? 1 : -1];

static inline uint8_t at(uint16_t position)
{
    return pd_rx.ring[position & PD_RING_MASK];
}

/* -- replies */

static void put_name(const char *name, uint8_t size)
{
    out_byte(size - 1);
    for (uint8_t i = 0; i < size - 1; i++)
        out_byte(PD_READ_FLASH(name + i));
}

static void say_hello(void)
{
    out_begin_apart(HELLO_REPLY, 0);
    for (uint8_t i = 0; i < 4; i++)
        out_byte(link.nonce[i]);
    out_byte(link.version);
    out_byte(PD_OLDEST_VERSION);
    out_byte(PD_NEWEST_VERSION);
    out_put(link.boot, 2);
    out_byte(link.cause);
    out_byte(PD_BUS);
    out_byte(PD_ADDRESS);
    out_byte((PD_BUS == PD_BUS_IS_I2C) | link.present << 1 | PD_RESET_LINE << 2 | PD_FRAME_LINE << 3);
    out_byte(PD_REPEATS);
    out_put(PD_MAX_PAYLOAD, 2);
    out_put(PD_WINDOW, 2);
    out_put(PD_WIDTH, 2);
    out_put(PD_HEIGHT, 2);
    out_byte(RATES);
    for (uint8_t i = 0; i < RATES; i++) {
        uint32_t rate = PD_READ_FLASH_LONG(rates + i);
        out_put((uint16_t)rate, 2);
        out_put((uint16_t)(rate >> 16), 2);
    }
    put_name(controller, sizeof controller);
    put_name(firmware, sizeof firmware);
    out_put(FEATURES, 2);
    out_put(PD_STORE_SIZE, 2);
    out_finish();
}

static uint16_t counter(volatile uint16_t *value)
{
    uint16_t now;
    PD_GUARDED(now = *value);
    return now;
}

static void say_status(void)
{
    out_begin_apart(STATUS, link.token);
    out_byte(link.expected);
    out_byte(link.fault);
    out_put(link.boot, 2);
    out_put(link.damaged, 2);
    out_put(counter(&pd_rx.overflows), 2);
    out_put(counter(&pd_rx.line_errors), 2);
    out_finish();
}

static void say_short(uint8_t kind, uint8_t seq, uint8_t value)
{
    out_begin(kind, seq);
    out_byte(value);
    out_finish();
}

static void reply(void)
{
    uint8_t room = out_room();
    uint8_t owed = link.owed;
    if (!owed || room < (owed & OWE_HELLO ? PD_TX_SIZE : 24))
        return;
    if (owed & OWE_ACK) {
        say_short(ACK, link.done, link.fault);
        owed &= ~OWE_ACK;
    } else if (owed & OWE_NAK) {
        say_short(NAK, link.expected, link.reason);
        owed &= ~OWE_NAK;
    } else if (owed & OWE_STATUS) {
        say_status();
        owed &= ~OWE_STATUS;
    } else if (owed & OWE_HELLO) {
        say_hello();
        owed &= ~OWE_HELLO;
    } else if (owed & OWE_BYTE) {
        out_begin_apart(BYTE, link.read_token);
        out_byte(link.read_fault);
        out_byte(link.read_value);
        out_finish();
        owed &= ~OWE_BYTE;
    } else {
        out_begin_apart(BOOT, 0);
        out_put(link.boot, 2);
        out_byte(link.cause);
        out_finish();
        owed = 0;
    }
    link.owed = owed;
}

/* -- work, in order */

static void fail(uint8_t fault)
{
    if (!link.fault)
        link.fault = fault;
}

/* Frees the ring up to the oldest byte that is still needed. */
static void release(void)
{
    uint16_t tail = link.running.kind ? link.running.start : link.ready.kind ? link.ready.start : in.start;
    PD_GUARDED(pd_rx.tail = tail);
}

static void complete(void)
{
    if (link.running.kind == HELLO) {
        link.owed |= OWE_HELLO;
    } else if (link.running.kind == READ) {
        link.owed |= OWE_BYTE;
    } else if (link.running.kind != POLL && link.running.kind < TURN) {
        link.done = link.running.seq;
        link.owed |= OWE_ACK;
    }
    link.running.kind = 0;
    release();
}

static void change_rate(const struct frame *frame)
{
    uint32_t rate = 0;
    if (((frame->end - frame->payload) & PD_RING_MASK) < 4) {
        fail(PD_MALFORMED);
        return;
    }
    for (uint8_t i = 4; i--;)
        rate = rate << 8 | at(frame->payload + i);
    for (uint8_t i = 0; i < RATES; i++)
        if (PD_READ_FLASH_LONG(rates + i) == rate) {
            link.next_rate = rate;
            return;
        }
    fail(PD_BAUD_NOT_OFFERED);
}

/* What is written of a frame, or nothing. */
static struct pd_tokens tokens = {pd_rx.ring, PD_RING_MASK, 0, 0, 1, 0};

static void look(void)
{
    tokens.at = tokens.end = 0;
    pd_bus_write(&tokens);
}

/* Whether a message ends a cycle: all that may write to the panel or to the store. */
static bool ends_cycle(uint8_t kind)
{
    return kind == HELLO || ((kind & 0xF0) == 0x10 && kind != BAUD);
}

/* Does what a frame asks; true if that goes on in the background. */
static bool execute(const struct frame *frame)
{
    switch (frame->kind) {
    case HELLO:
        link.fault = PD_OK;
        link.done = 0xFF;
        for (uint8_t i = 0; i < 4; i++)
            link.nonce[i] = at(frame->payload + i);
        look();
        return true;
    case POLL:
        link.token = frame->seq;
        link.armed = true;
        link.owed |= OWE_STATUS;
        return false;
    case READ:
        link.read_token = frame->seq;
        pd_bus_read();
        return true;
    case TURN:
        cycle_turn(ends_cycle(link.ready.kind));
        return true;
    case LOOK:
        look();
        return true;
    case WRITE:
    case WRITE_END:
        if (link.fault || frame->payload == frame->end)
            return false;
        tokens.at = frame->payload;
        tokens.end = frame->end;
        if (!pd_tokens_valid(&tokens)) {
            fail(PD_MALFORMED);
            return false;
        }
        pd_bus_write(&tokens);
        return true;
    case BAUD:
        if (!link.fault)
            change_rate(frame);
        return false;
    case RESET:
        if (frame->payload == frame->end) {
            fail(PD_MALFORMED);
            return false;
        }
        link.fault = PD_OK;
        if (PD_RESET_LINE && at(frame->payload) & 1)
            pd_port_reset_panel();
        return false;
    case STORE:
    case CYCLE:
        if (!(link.features & CYCLES))
            fail(PD_UNKNOWN_KIND);
        else if (!link.fault && !(frame->kind == STORE ? cycle_store : cycle_begin)(frame->payload, frame->end))
            fail(PD_MALFORMED);
        return false;
    default:
        fail(PD_UNKNOWN_KIND);
        return false;
    }
}

/* The next frame need not wait for an acknowledgement to be sent, unless it changes what that would say. */
static bool may_begin(void)
{
    uint8_t kind = link.ready.kind;
    uint8_t bearable = kind == WRITE || kind == WRITE_END ? OWE_ACK : 0;
    return kind && !link.next_rate && !(link.owed & ~bearable);
}

static void bus_ended(uint8_t fault)
{
    if (link.running.kind == HELLO) {
        link.present = fault == PD_OK;
    } else if (link.running.kind == READ) {
        link.read_fault = fault;
        link.read_value = fault ? 0 : pd_bus.value;
    } else {
        fail(fault);
        if (fault && link.running.kind == TURN)
            cycle_end();
    }
}

static void run(void)
{
    link.bus_steps = pd_bus.steps - 1;
    if (!execute(&link.running))
        complete();
}

/* Looks at the panel when nothing has come for so long. */
static void watch(uint16_t now)
{
    if ((uint16_t)(now - link.quiet_since) < QUIET_MS || link.running.kind)
        return;
    link.quiet_since = now;
    if (!(link.features & WATCH) || link.fault || cycle_goes_on())
        return;
    link.running.kind = LOOK;
    link.running.start = in.start;
    run();
}

/* Begins what is next: a message that waits, or a sub-picture that is due. What ends a cycle has the first sub-picture
 * written before, unless it is shown.
 */
static void begin_next(void)
{
    bool ending = cycle_goes_on() && ends_cycle(link.ready.kind);
    if (ending && !cycle_within()) {
        cycle_end();
        ending = false;
    }
    if (may_begin() && !ending) {
        link.running = link.ready;
        link.ready.kind = 0;
        run();
    } else if (ending || (cycle_goes_on() && cycle_due())) {
        link.running.kind = TURN;
        link.running.start = link.ready.kind ? link.ready.start : in.start;
        run();
    }
}

static void work(uint16_t now)
{
    if (link.running.kind) {
        if (pd_bus.state == PD_BUS_BUSY) {
            if (link.bus_steps != pd_bus.steps) {
                link.bus_steps = pd_bus.steps;
                link.bus_until = now + BUS_PATIENCE_MS;
                return;
            }
            if ((int16_t)(now - link.bus_until) < 0)
                return;
            pd_port_bus_abort();
            pd_bus_done(PD_BUS_STUCK);
        }
        pd_bus.state = PD_BUS_IDLE;
        bus_ended(pd_bus.fault);
        complete();
    }
    begin_next();
}

/* -- frames */

static void doubt(uint16_t now, uint16_t patience)
{
    if (link.fast && !link.doubtful) {
        link.doubtful = true;
        link.revert_at = now + patience;
    }
}

static void queue(uint8_t kind, uint8_t seq)
{
    link.ready.kind = kind;
    link.ready.seq = seq;
    link.ready.start = in.start;
    link.ready.payload = (in.start + 2) & PD_RING_MASK;
    link.ready.end = (in.end - 2) & PD_RING_MASK;
}

static void nak(uint8_t reason)
{
    link.armed = false;
    link.reason = reason;
    link.owed |= OWE_NAK;
}

static void greet(void)
{
    if (in.length < IN_ENVELOPE + 6)
        return;
    uint8_t oldest = at(in.start + 6), newest = at(in.start + 7);
    if (newest > PD_NEWEST_VERSION)
        newest = PD_NEWEST_VERSION;
    link.version = newest >= oldest && newest >= PD_OLDEST_VERSION ? newest : 0;
    link.features = 0;
    if (link.version && in.length >= IN_ENVELOPE + 8)
        link.features = at(in.start + 8) & FEATURES;
    link.expected = 0;
    link.armed = true;
    queue(HELLO, 0);
}

static void take_sequenced(uint8_t kind, uint8_t seq)
{
    uint8_t ahead = seq - link.expected;
    if (ahead >= 128) {
        link.owed |= OWE_ACK;
    } else if (ahead) {
        if (link.armed)
            nak(2);
    } else {
        link.expected++;
        link.armed = true;
        queue(kind, seq);
    }
}

/* A whole frame lies between in.start and in.end. */
static void take_frame(void)
{
    uint8_t kind = at(in.start);
    uint8_t seq = at(in.start + 1);
    link.doubtful = false;
    if (kind == HELLO)
        greet();
    else if (kind != POLL && !(PD_READS && kind == READ) && (kind & 0xF0) != 0x10)
        return;
    else if (!link.version)
        link.owed |= OWE_BOOT;
    else if (kind == POLL || (kind == READ && link.features & READS))
        queue(kind, seq);
    else if (kind != READ)
        take_sequenced(kind, seq);
}

static void listen(uint16_t now)
{
    enum in_event event = in_decode();
    if (event == IN_IDLE) {
        watch(now);
        return;
    }
    link.quiet_since = now;
    if (link.fast)
        doubt(now, DOUBT_MS);
    if (event == IN_FRAME) {
        take_frame();
    } else if (event == IN_DAMAGED) {
        link.damaged++;
        if (link.version)
            nak(1);
    }
    if (event != IN_PART)
        in_begin();
    release();
}

/* What came at the old rate is thrown away. */
static void set_rate(uint32_t rate)
{
    link.fast = rate != BASE_RATE;
    link.doubtful = false;
    pd_port_set_rate(rate);
    in_skip();
    release();
}

static void mind_rate(uint16_t now)
{
    uint16_t errors = counter(&pd_rx.line_errors);
    if (errors != link.line_errors) {
        link.line_errors = errors;
        doubt(now, DOUBT_MS);
    }
    if (link.next_rate && !link.owed && pd_port_transmitted()) {
        set_rate(link.next_rate);
        link.next_rate = 0;
        doubt(now, PROBATION_MS);
    }
    if (link.doubtful && (int16_t)(now - link.revert_at) >= 0) {
        set_rate(BASE_RATE);
    }
}

void pd_start(uint16_t boot, uint8_t cause)
{
    link.running.kind = link.ready.kind = 0;
    if (PD_RESET_LINE)
        pd_port_reset_panel();
    link.version = link.fault = link.expected = link.features = 0;
    link.done = 0xFF;
    link.armed = link.fast = link.doubtful = false;
    link.damaged = link.line_errors = 0;
    link.next_rate = 0;
    link.boot = boot;
    link.cause = cause;
    link.owed = OWE_BOOT;
    pd_bus.state = PD_BUS_IDLE;
    cycle_clear();
    pd_rx.overflows = pd_rx.line_errors = 0;
    out_clear();
    pd_rx.head = in.read = 0;
    in_begin();
    release();
}

void pd_poll(uint16_t milliseconds)
{
    work(milliseconds);
    reply();
    mind_rate(milliseconds);
    if (!link.ready.kind && !link.next_rate && !link.owed)
        listen(milliseconds);
}
