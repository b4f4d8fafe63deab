"""The host's side of the link: sessions, credits, acknowledgements and recovery over any pyserial port."""

from __future__ import annotations

import math
import os
import struct
import time
from collections import deque
from collections.abc import Callable, Iterable
from contextlib import suppress
from itertools import islice
from types import TracebackType
from typing import Any, NoReturn

from firmware_protocol.errors import (
    DeviceResetError,
    LinkError,
    LinkLostError,
    LinkTimeoutError,
    NoDeviceError,
    PanelFaultError,
    VersionError,
)
from firmware_protocol.frames import DELIMITER, encode_frame, wire_size
from firmware_protocol.line import PORT_ERRORS, Line, LinkStats
from firmware_protocol.messages import (
    BASE_BAUDRATE,
    HOST_FEATURES,
    NEWEST_VERSION,
    OLDEST_VERSION,
    Ack,
    Baud,
    Boot,
    Byte,
    Fault,
    Feature,
    Hello,
    HelloReply,
    Kind,
    Message,
    Nak,
    PanelBus,
    Poll,
    Read,
    Status,
    cause_text,
    encode,
)
from firmware_protocol.pace import BUS_BYTE, SLOW_BUS_BYTE, Pace, RoundTrip, Work
from firmware_protocol.runs import LEAST_PAYLOAD, Run

#: Seconds between two attempts to be heard, to begin with.
PATIENCE = 0.25
#: How often a silent device is asked before it is given up.
ATTEMPTS = 7
#: How often it is asked at a faster rate before the first rate is tried: it may have restarted.
HOPES = 2
#: How often it is asked early in one recovery: at once, as something came damaged, its answer perhaps, or when the
#: answer is later than it should be.
HURRIES = 2
#: Seconds after which a faster rate that failed is tried again, to begin with and at most; twice as long each time.
RATE_AGAIN = 10.0
RATE_AGAIN_MOST = 640.0
#: Seconds without an acknowledged frame, in spite of answers, after which the line is given up.
STALLED = 15.0
#: Most frames under way; half the sequence numbers must stay unambiguous.
MAX_IN_FLIGHT = 100
#: Rates outside are none that a serial line has.
SENSIBLE_RATES = range(1_200, 20_000_001)

_CYCLE = struct.Struct("<HB")
_PROBATION = 0.3
# How long, and how often, a device is greeted at the rate of a session that broke off.
_STILL_THERE = 0.15
_STILL_THERE_EACH = 0.06

_FAULTS = {
    Fault.ADDRESS_NACK: "no panel answers at {address:#04x} behind it: check the panel's wiring and address",
    Fault.DATA_NACK: "the panel stopped acknowledging in the middle of a write: check its wiring and supply",
    Fault.BUS_STUCK: "the panel's bus is stuck: check pull-up resistors and wiring, then power the panel off and on",
    Fault.MALFORMED: "it refused a malformed message: update the firmware, or report this",
    Fault.UNKNOWN_KIND: "it does not know a message that this version sends: update the firmware",
    Fault.BAUD_NOT_OFFERED: "it does not offer that baud rate",
}
_SPI_STOPPED = "its SPI has stopped: press the board's reset button, and check that nothing pulls its lines"


class HostLink:
    """A session with the device on a serial port.

    Not thread-safe; it starts no thread. Between calls nothing needs to run.

    Parameters
    ----------
    port : pyserial port
        Open, from ``serial.Serial`` or ``serial.serial_for_url``. The link sets its ``timeout`` and ``baudrate`` and
        closes it in `close`.
    baudrate : int, optional
        Bits a second after the handshake, one of those that the device offers. Default: the rate the device likes
        best. Where it does not work, the link goes on at 115 200; `HostLink.baudrate` says so.
    timeout : float, default 3.0
        Seconds that a call waits while the device answers nothing and acknowledges nothing. Boards that reset when a
        port is opened need two.
    clock : callable, default `time.monotonic`
        Seconds.

    Attributes
    ----------
    device : HelloReply
        What answered.
    cycling : bool
        Whether it was told to write sub-pictures in turn, and nothing else since.

    Raises
    ------
    LinkError
        One of its kinds: nobody there, no common version, the port lost.

    Examples
    --------
    >>> import serial                                                       # doctest: +SKIP
    >>> with HostLink(serial.Serial("/dev/ttyACM0", 115200)) as link:       # doctest: +SKIP
    ...     link.write([(False, b"\\xb0\\x00\\x10"), (True, b"\\xff")])
    """

    def __init__(
        self,
        port: Any,
        *,
        baudrate: int | None = None,
        timeout: float = 3.0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        if baudrate is not None and baudrate <= 0:
            raise ValueError(f"baudrate must be positive, not {baudrate}")
        self._line = Line(port)
        self.timeout = timeout
        self.clock = clock
        self.device = HelloReply(0)
        self._pace = Pace(self.device, BASE_BAUDRATE)
        self._wanted_rate = baudrate
        # What is not acknowledged; of that part of it that is under way the sizes on the wire, and seconds on the bus.
        self._work: deque[Work] = deque()
        self._sizes: deque[int] = deque()
        self._on_bus: deque[float] = deque()
        self._trip = RoundTrip()
        self._since = 0.0  # when the device could begin with the oldest frame under way
        self._token = self._first = 0
        self._last_rate = BASE_BAUDRATE  # that the device may still listen at
        self._fast_again = math.inf  # when a faster rate that failed is due again
        self._fast_patience = RATE_AGAIN
        self._closed = False
        self._stored = b""  # what the store of this session's device holds
        self.cycling = False
        self._forget()
        self.connect()

    def __enter__(self) -> HostLink:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def stats(self) -> LinkStats:
        """Bytes and events so far."""
        return self._line.stats

    @property
    def baudrate(self) -> int:
        """The rate in use, bits a second."""
        return self._line.baudrate

    def connect(self) -> None:
        """Begin a new session, opening the port again if it was lost. `submit` does it where it must."""
        self._forget()
        self._progress = self.clock()
        if not self._still_there():
            self._line.open()
            self._shake_hands()
        if self._fast_again == math.inf or self.clock() >= self._fast_again:
            self._choose_rate()
        self._in_session = True
        self.stats.sessions += 1

    def write(self, runs: Iterable[Run], *, end: bool = True) -> int:
        """Write runs to the panel and wait until its bus has taken them; see `submit`.

        Returns
        -------
        int
            Bytes that this put on the wire, what was sent again included.
        """
        before = self.stats.bytes_sent
        self.submit(runs, end=end)
        self.drain()
        return self.stats.bytes_sent - before

    def submit(self, runs: Iterable[Run], *, end: bool = True) -> None:
        """Send runs to the panel without waiting for the last acknowledgements.

        Parameters
        ----------
        runs : iterable of (bool, bytes or memoryview)
            Whether the bytes are data (True) or commands (False), and the bytes.
        end : bool, default True
            Whether the runs complete a picture.

        Raises
        ------
        LinkError
            One of its kinds, for this or for an earlier call's runs. What was under way is lost; the next call
            begins anew.
        """
        self._begin()
        self.cycling = False
        self._work.extend(self._pace.writes(runs, end))
        self._pump()
        while len(self._sizes) < len(self._work):
            self._step()

    def drain(self) -> None:
        """Wait until everything submitted is acknowledged."""
        while self._work:
            self._step()

    def reset_panel(self) -> None:
        """Pull the panel's reset line, where the device has one."""
        self._begin()
        self.cycling = False
        self._sequenced(Kind.RESET, b"\1")

    @property
    def store(self) -> int:
        """Bytes that the device keeps of sub-pictures to write them in turn; 0 if it does not."""
        return self.device.store if self.device.features & Feature.CYCLE else 0

    def cycle(self, content: bytes, count: int) -> None:
        """Have the device write sub-pictures in turn until there is something else to write.

        Parameters
        ----------
        content : bytes
            What `pack_cycle` made of them, no longer than `store`; what of it the device holds already is not sent.
        count : int
            How many they are. The panel shows the first one.

        Raises
        ------
        LinkError
            One of its kinds; the device does not cycle then.
        """
        self._begin()
        self.drain()
        self.cycling = False
        before, self._stored = self._stored, b""
        changed = [at for at, byte in enumerate(content) if before[at : at + 1] != bytes((byte,))]
        if changed:
            self._work.extend(self._pace.stores(content[changed[0] : changed[-1] + 1], changed[0]))
        self._sequenced(Kind.CYCLE, _CYCLE.pack(len(content), count))
        self._stored = content + before[len(content) :]
        self.cycling = count > 0

    def read_panel(self) -> int:
        """Return a byte read from the panel, for chips that say how they are.

        Raises
        ------
        PanelFaultError
            The panel does not answer.
        LinkError
            The device cannot read, or one of its kinds.
        """
        self._begin()
        if not self.device.features & Feature.READ:
            raise LinkError(f"the board on {self._line.name} cannot read from its panel")
        self.drain()
        for patience in (*(self._trip.most * 2**hurry for hurry in range(HURRIES)), self._patience):
            answer = self._asked_to_read(min(patience, self._patience))
            if answer is None:
                continue
            if answer.fault:
                raise PanelFaultError(answer.fault, self._fault_text(answer.fault))
            return answer.value
        raise LinkTimeoutError(f"the board on {self._line.name} does not say what its panel answers; try again")

    def _asked_to_read(self, patience: float) -> Byte | None:
        """Ask once; return the answer, or None where it is lost or does not come in time."""
        self._token = self._token + 1 & 0xFF
        self._line.send(DELIMITER + encode(Read(self._token)))
        until, damaged = self.clock() + patience, self.stats.damaged
        while self.clock() < until and self.stats.damaged == damaged:
            for message in self._line.receive():
                if isinstance(message, Byte) and message.token == self._token:
                    return message
                self._handle(message)
        return None

    def status(self) -> Status:
        """Ask the device for its counters."""
        self._begin()
        self.drain()
        self._poll()
        while self._polling is not None:
            self._step()
        return self._status

    def ping(self) -> float:
        """Return the seconds from a question to its answer."""
        start = self.clock()
        self.status()
        return self.clock() - start

    def close(self) -> None:
        """Leave the device at its first rate and close the port; may be called again."""
        if self._in_session and not self._work and self.baudrate != BASE_BAUDRATE:
            with suppress(LinkError):
                self._line.send(encode(Baud(self._base, BASE_BAUDRATE)))
        self._forget()
        self._closed = True
        self._line.close()

    # -- sessions

    def _begin(self) -> None:
        if self._closed:
            raise LinkLostError(f"the link on {self._line.name} was closed; open another")
        if self._line.lost or not self._in_session:
            self.connect()
            return
        self._progress = self.clock()
        if self._progress >= self._fast_again:
            boot = self.device.boot
            self._choose_rate()
            if self.device.boot != boot:
                self._restarted(self.device.cause)

    @property
    def _patience(self) -> float:
        """Seconds to wait for an answer at first: less where the caller has no time."""
        return min(PATIENCE, self.timeout / 8)

    def _forget(self) -> None:
        self._in_session = False
        self._work.clear()
        self._sizes.clear()
        self._on_bus.clear()
        self._base = 0
        self._polling: int | None = None
        self._failures = self._hurries = 0
        self._deadline = 0.0
        self._settling = False
        self._fault = Fault.NONE
        self._stored = b""
        self.cycling = False

    def _still_there(self) -> bool:
        """Whether a device that a session broke off with answers at that session's rate."""
        if self._line.lost or self._last_rate == BASE_BAUDRATE:
            return False
        self._line.set_rate(self._last_rate)
        return self._greeted(min(_STILL_THERE, self.timeout / 4), _STILL_THERE_EACH) is None

    def _shake_hands(self) -> None:
        received = self.stats.bytes_received
        came = self._greeted(self._progress + self.timeout - self.clock(), PATIENCE)
        if came is not None:
            raise NoDeviceError(self._diagnosis(self.stats.bytes_received - received, came))
        self._last_rate = BASE_BAUDRATE

    def _greeted(self, seconds: float, patience: float) -> set[type[Message]] | None:
        """Say HELLO until it is answered, and return None; after so many seconds, what came instead."""
        came: set[type[Message]] = set()
        deadline = self.clock() + seconds
        while self.clock() < deadline:
            nonce = int.from_bytes(os.urandom(4), "little")
            self._line.send(DELIMITER + encode(Hello(nonce, features=HOST_FEATURES)))
            until = min(deadline, self.clock() + patience)
            while self.clock() < until:
                for message in self._line.receive():
                    if isinstance(message, HelloReply) and message.nonce == nonce:
                        self._accept(message)
                        return None
                    came.add(type(message))
        return came

    def _diagnosis(self, received: int, came: set[type[Message]]) -> str:
        if came & {HelloReply, Status, Boot, Ack, Nak, Byte}:
            return f"the board on {self._line.name} speaks but does not answer: press its reset button and try again"
        if Hello in came:
            return f"{self._line.name} sends back what it is sent: nothing but a loop-back is connected there"
        if received:
            return (
                f"something talks on {self._line.name} ({received} bytes in {self.timeout:g} s), and it is not "
                f"paneldraw's firmware at {BASE_BAUDRATE} baud: check the port, or flash the firmware: "
                "paneldraw firmware flash"
            )
        return (
            f"nothing answers on {self._line.name} at {BASE_BAUDRATE} baud: check the port and the cable, and that the "
            f"board runs paneldraw's firmware: paneldraw firmware flash {self._line.name}"
        )

    def _accept(self, reply: HelloReply) -> None:
        if not OLDEST_VERSION <= reply.version <= NEWEST_VERSION:
            side = "paneldraw" if reply.oldest > NEWEST_VERSION else "the board's firmware"
            raise VersionError(
                f"the board on {self._line.name} speaks protocol versions {reply.oldest} to {reply.newest}, this "
                f"paneldraw {OLDEST_VERSION} to {NEWEST_VERSION}: update {side}"
            )
        if reply.max_payload < LEAST_PAYLOAD or reply.window < wire_size(LEAST_PAYLOAD):
            raise VersionError(f"the board on {self._line.name} takes too little at a time: update its firmware")
        if reply.boot != self.device.boot:
            self._fast_again, self._fast_patience = math.inf, RATE_AGAIN
        self.device = reply
        self._pace = Pace(self.device, self.baudrate)

    def _choose_rate(self) -> None:
        offered = [rate for rate in self.device.bauds if rate in SENSIBLE_RATES]
        wanted = self._wanted_rate or (offered[0] if offered else BASE_BAUDRATE)
        self._fast_again = math.inf
        if wanted in (BASE_BAUDRATE, self.baudrate) or not offered:
            return
        if wanted not in offered:
            raise LinkError(
                f"the board on {self._line.name} does not offer {wanted} baud; it offers {', '.join(map(str, offered))}"
            )
        try:
            self._sequenced(Kind.BAUD, wanted.to_bytes(4, "little"))
        except PanelFaultError:  # the device does without, after all
            self._put_off()
            return
        try:
            self._line.set_rate(wanted)
            if self._heard():
                self._pace = Pace(self.device, self.baudrate)
                self._last_rate = wanted
                return
            self._put_off()
        except PORT_ERRORS:
            self._wanted_rate = BASE_BAUDRATE  # the adapter cannot do it
        self._line.set_rate(BASE_BAUDRATE)
        self._wait(_PROBATION)
        in_session = self._in_session
        self._forget()
        self._progress = self.clock()
        self._shake_hands()
        self._in_session = in_session

    def _put_off(self) -> None:
        """Try a faster rate later."""
        self._fast_again = self.clock() + self._fast_patience
        self._fast_patience = min(RATE_AGAIN_MOST, 2 * self._fast_patience)

    def _heard(self) -> bool:
        until = self.clock() + _PROBATION
        while self.clock() < until:
            self._poll()
            again = self.clock() + _PROBATION / 5
            while self.clock() < again:
                for message in self._line.receive():
                    self._handle(message)
                if self._polling is None:
                    return True
        self._polling = None
        return False

    def _wait(self, seconds: float) -> None:
        until = self.clock() + seconds
        while self.clock() < until:
            self._line.receive()

    # -- the window

    def _sequenced(self, kind: Kind, payload: bytes) -> None:
        self._work.append((kind, payload))
        self._pump()
        self.drain()

    def _pump(self) -> None:
        """Send what the credits allow."""
        sizes = self._sizes
        if self._polling is not None or len(sizes) == len(self._work):
            return
        idle = not sizes
        batch = []
        under_way = sum(sizes)
        for kind, payload in islice(self._work, len(sizes), None):
            frame = encode_frame(kind, self._base + len(sizes) & 0xFF, payload)
            under_way += len(frame)
            if sizes and (under_way > self._pace.window or len(sizes) >= MAX_IN_FLIGHT):
                break
            sizes.append(len(frame))
            self._on_bus.append(self._pace.on_bus(kind, payload))
            batch.append(frame)
        if idle:
            self._since = self.clock()
            self._expect()
        if batch:
            self.stats.frames += len(batch)
            self._line.send(b"".join(batch))

    def _step(self) -> None:
        """Wait for something to happen and act on it."""
        damaged = self.stats.damaged
        for message in self._line.receive():
            self._handle(message)
        if self.stats.damaged != damaged and (self._sizes or self._polling is not None) and self._hurries < HURRIES:
            self._hurries += 1
            self._poll()
        if self._fault and not self._settling:
            self._settle(self._fault)
        if self._work or self._polling is not None:
            if self.clock() >= self._deadline:
                self._time_out()
            self._pump()

    def _handle(self, message: Message) -> None:
        match message:
            case Ack(seq, fault):
                self._done((seq - self._base & 0xFF) + 1, learn=True)
                self._fault = self._fault or fault
            case Nak():
                self.stats.naks += 1
                self._poll()
            case Status(token) if self._answers(token):
                if message.boot != self.device.boot:
                    self._restarted(self.device.cause)
                self._polling = None
                self._failures = self._hurries = 0
                self._last_rate = self.baudrate
                self._status = message
                self._fault = self._fault or message.fault
                self._go_back(message.expected)
            case Boot(cause=cause):
                self._restarted(cause)

    def _answers(self, token: int) -> bool:
        """Whether a STATUS answers any POLL of the present recovery: what was sent before one was sent before all."""
        return self._polling is not None and self._polling - token & 0xFF <= self._polling - self._first & 0xFF

    def _done(self, count: int, learn: bool = False) -> None:
        """Retire the ``count`` oldest frames; more than are under way means an old acknowledgement."""
        if count > len(self._sizes):
            return
        needed = sum(islice(self._sizes, count)) * 10 / self.baudrate
        needed += sum(islice(self._on_bus, count)) * BUS_BYTE / SLOW_BUS_BYTE
        for _ in range(count):
            self._sizes.popleft()
            self._on_bus.popleft()
            self._work.popleft()
        self._base = self._base + count & 0xFF
        self._failures = 0
        self._progress = self.clock()
        if learn:
            self._trip.took(self._progress - self._since - needed)
        self._since = self._progress
        self._pace.speed_up(count)
        self._expect()

    def _go_back(self, expected: int) -> None:
        """Begin again with the first frame that the device has not taken: all sent before the POLL has been seen."""
        count = expected - self._base & 0xFF
        if count > len(self._sizes):
            self._fail(DeviceResetError, f"the board on {self._line.name} has lost count of what it was sent")
        if count:
            self._done(count)
        if self._sizes:
            self._pace.slow_down()
        self.stats.resent += len(self._sizes)
        self._sizes.clear()
        self._on_bus.clear()
        self._work = deque(piece for work in self._work for piece in self._pace.again(work))

    def _expect(self) -> None:
        now = self.clock()
        on_the_way = 20 * sum(self._sizes) / self.baudrate
        if self._last_rate == BASE_BAUDRATE:
            patience = self._patience * min(4, 2**self._failures)
        else:  # quick to fall back, and then to find a device that does so too
            patience = self._patience * (1 if self._last_rate == self.baudrate else 2)
        if self._hurries < HURRIES and not self._failures:
            patience = min(patience, self._trip.most * 2**self._hurries)
        patience += sum(self._on_bus)
        self._deadline = on_the_way + min(now + patience, max(now, self._progress + self.timeout))

    def _poll(self) -> None:
        if self.clock() - self._progress > min(STALLED, self.timeout):
            self._fail(LinkTimeoutError, f"the line to {self._line.name} is too noisy: lower the baud rate")
        self._token = self._token + 1 & 0xFF
        if self._polling is None:
            self._first = self._token
        self._polling = self._token
        self._expect()
        self._line.send(DELIMITER + encode(Poll(self._token)))

    def _time_out(self) -> None:
        self.stats.timeouts += 1
        if self._hurries < HURRIES and not self._failures:
            self._hurries += 1
            self._poll()
            return
        self._failures += 1
        if self._failures > ATTEMPTS or self.clock() - self._progress >= self.timeout:
            self._fail(
                LinkTimeoutError,
                f"the board on {self._line.name} has stopped answering: check the cable, or press its reset button",
            )
        if self._failures > HOPES and self.baudrate != BASE_BAUDRATE:
            self._line.set_rate(BASE_BAUDRATE)
            self._pace = Pace(self.device, BASE_BAUDRATE)
            self._put_off()
        self._poll()

    def _settle(self, fault: Fault) -> NoReturn:
        """Let the device run through what it will not write, clear its fault, and tell the caller."""
        self._settling = True
        while len(self._work) > len(self._sizes):
            self._work.pop()
        self.drain()
        self.cycling = False
        self._sequenced(Kind.RESET, b"\0")
        self._settling = False
        self._fault = Fault.NONE
        raise PanelFaultError(fault, self._fault_text(fault))

    def _fault_text(self, fault: Fault) -> str:
        text = _FAULTS.get(fault, "it reports a fault").format(address=self.device.address)
        if fault == Fault.BUS_STUCK and self.device.bus == PanelBus.SPI:
            text = _SPI_STOPPED
        return f"the board on {self._line.name} works, but {text}"

    def _restarted(self, cause: int) -> NoReturn:
        self._last_rate = self.baudrate
        self._fail(DeviceResetError, f"the board on {self._line.name} has restarted ({cause_text(cause)})")

    def _fail(self, kind: type[LinkError], text: str) -> NoReturn:
        self._forget()
        raise kind(text)
