"""What a log of a bus is replayed from ends in the same frames, at the same times, and in the same words."""

from __future__ import annotations

import contextlib
import gzip
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from smbus2 import i2c_msg

from paneldraw import Panel, controllers, simulator
from paneldraw.simulator import log
from paneldraw.simulator.chip import Chip
from paneldraw.transports import I2CTransport, SPITransport

from .helpers import init, random_picture

ON = bytes([0x00]) + init(128, 64)
#: Commands of the SSD1306 that scroll nothing: a moving picture moves in the bus's time, which a log has by calls.
COMMANDS = st.sampled_from(
    "A6 A7 A5 A4 AE AF 8140 B3 B7 02 15 2000 2002 D308 45 A0 C0 21057A 220106 E3".split()  # noqa: SIM905 - readable
).map(bytes.fromhex)
PAYLOADS = st.one_of(
    st.lists(COMMANDS, min_size=1, max_size=4).map(lambda commands: b"\x00" + b"".join(commands)),
    st.binary(min_size=1, max_size=300).map(lambda data: b"\x40" + data),
    st.just(b""),
)
MESSAGES = st.lists(
    st.tuples(st.sampled_from([0x3C, 0x3C, 0x3C, 0x29]), PAYLOADS, st.booleans()), min_size=1, max_size=4
)


def same(one: Chip, other: Chip) -> None:
    assert np.array_equal(one.pixels, other.pixels)
    assert len(one.frames) == len(other.frames)
    for frame, again in zip(one.frames, other.frames, strict=True):
        assert np.array_equal(frame.pixels, again.pixels)
        assert frame.seconds == pytest.approx(again.seconds, abs=1e-9)
        assert frame.wire_bytes == again.wire_bytes
    assert (one.violations, one.remarks) == (other.violations, other.remarks)


@given(st.lists(st.tuples(MESSAGES, st.integers(0, 3), st.floats(0, 0.1)), max_size=12))
def test_i2c_calls_come_back(tmp_path: Path, calls: list[Any]) -> None:
    chip, again = simulator.SSD1306(), simulator.SSD1306()
    bus = simulator.I2CBus({0x3C: chip}, timer=None)
    with simulator.Log(bus, tmp_path / "i2c.log"):
        bus.i2c_rdwr(i2c_msg.write(0x3C, ON))
        for messages, mishap, pause in calls:
            bus.idle(pause)
            if mishap:
                bus.fail(errno=(5, 121, 0)[mishap - 1], at_byte=(3, None, 2)[mishap - 1])
            parts = [
                i2c_msg.read(address, 2) if read and not payload else i2c_msg.write(address, payload)
                for address, payload, read in messages
            ]
            with contextlib.suppress(OSError):
                bus.i2c_rdwr(*parts)
            bus.clear_faults()
    told = simulator.replay(tmp_path / "i2c.log", again)
    assert (told.form, told.address, told.remarks) == ("a log", 0x3C, [])
    same(chip, again)


SPI_STEPS = st.lists(
    st.one_of(
        st.tuples(st.just("command"), st.lists(COMMANDS, min_size=1, max_size=3).map(b"".join)),
        st.tuples(st.just("data"), st.binary(min_size=1, max_size=200)),
        st.tuples(st.just("reset"), st.just(b"")),
        st.tuples(st.just("select"), st.just(b"")),
        st.tuples(st.just("lost"), st.binary(min_size=4, max_size=20)),
    ),
    max_size=20,
)


@pytest.mark.parametrize("cs", [None, 8])
@given(steps=SPI_STEPS)
def test_chip_selects_come_back(tmp_path: Path, cs: int | None, steps: list[tuple[str, bytes]]) -> None:
    """With a reset line, a chip select that the driver drives itself or leaves to the bus, and lost bytes."""
    chip, again = simulator.SSD1306(), simulator.SSD1306()
    bus = simulator.SPIBus(chip, cs=cs, timer=None)
    with simulator.Log(bus, tmp_path / "spi.log.gz"):
        for kind, run in [("select", b""), ("command", ON[1:]), *steps]:
            if kind == "reset":
                bus.pins.set(25, 0)
                if run:
                    bus.spi.writebytes2(b"\xaf")  # nobody listens
                bus.pins.set(25, 1)
            elif kind == "select" and cs is not None:
                bus.pins.set(cs, 1)
                bus.pins.set(cs, 0)
            elif run:
                bus.pins.set(24, kind == "data")
                if kind == "lost":
                    bus.fail(errno=0, at_byte=3)
                bus.spi.writebytes2(run)
    assert gzip.decompress((tmp_path / "spi.log.gz").read_bytes()).startswith(b"# seconds c<hex> d<hex>")
    told = simulator.replay(tmp_path / "spi.log.gz", again)
    assert (told.form, told.address) == ("a log", None)
    same(chip, again)


@pytest.mark.parametrize("name", sorted(controllers.CHIPS))
def test_pictures_of_every_chip_come_back(tmp_path: Path, name: str) -> None:
    record = controllers.CHIPS[name]()
    twin, again = (getattr(simulator, name.upper())() for _ in range(2))
    picture = random_picture(record.width, record.height, 3) * (2**record.depth - 1)
    bus: Any
    wiring: dict[str, Any] = {}
    if record.buses == ("spi",):
        wiring = {"dc": None, "reset": None} if record.registers else {"dc": None} if record.synced else {}
        bus = simulator.SPIBus(twin, timer=None, **wiring)
        bus.spi.cshigh = record.synced
    else:
        address = controllers.CHIPS[name].address
        wiring = {"data_address": address + 1} if "i2c-pair" in record.buses else {}
        bus = simulator.I2CBus({address: twin} | ({address + 1: twin.data} if wiring else {}), timer=None)
    with simulator.Log(bus, tmp_path / "panel.log"):
        if record.buses == ("spi",):
            transport: Any = SPITransport(spi=bus.spi, pins=bus.pins, **wiring)
        else:
            transport = I2CTransport(bus, address, **wiring)
        with Panel(record, transport) as panel:
            panel.show(picture)
            panel.show(picture[::-1])
            panel.show(np.zeros_like(picture))
    simulator.replay(tmp_path / "panel.log", again, usual=controllers.CHIPS[name].address)
    assert len(twin.frames) > 1
    same(twin, again)


def test_a_log_is_text(tmp_path: Path) -> None:
    bus = simulator.I2CBus({0x3C: simulator.SSD1306()}, timer=None)
    with simulator.Log(bus, tmp_path / "a.log"):
        bus.i2c_rdwr(i2c_msg.write(0x3C, b"\x00\xb0"), i2c_msg.read(0x3C, 2))
        with pytest.raises(OSError, match="121"):
            bus.write_quick(0x3D)
    bus.write_byte(0x3C, 0x00)  # after the log
    assert (tmp_path / "a.log").read_text().splitlines() == [
        "# seconds address w/r ack/nak payload",
        "0.000142500 3c w ack 00b0",
        "+ 3c r ack 4343",
        "0.000170000 3d w nak",
    ]


def test_a_bus_has_one_log(tmp_path: Path) -> None:
    bus = simulator.SPIBus(simulator.SSD1306())
    with simulator.Log(bus, tmp_path / "a.log"), pytest.raises(ValueError, match="has a log already"):
        simulator.Log(bus, tmp_path / "b.log")
    simulator.Log(bus, tmp_path / "b.log").close()
    with pytest.raises(OSError, match="missing"):
        simulator.Log(bus, tmp_path / "missing" / "c.log")
    assert bus.log is None


EVENTS: list[log.Event] = [
    log.Call(0.5, (log.Message(0x3C, b"\x00\xaf"), log.Message(0x3C, b"\x43", read=True))),
    log.Call(0.75, (log.Message(0x70, b"", acknowledged=False),)),
    log.Select(1.0, ((False, b"\xaf"), (True, b"\x01\x02"), (None, b"\x03")), ends=False),
    log.Select(1.25, ()),
    log.Reset(2.0),
]


def test_events_are_lines_and_lines_events() -> None:
    text = [line for event in EVENTS for line in log.lines(event)]
    assert all(map(log.is_line, text))
    assert list(log.read(enumerate(text, 1))) == EVENTS


@pytest.mark.parametrize(
    "line", ["0.1 3c w ack 0", "0.1 3c w maybe 00", "0.1 c0", "0.1 q00", "nonsense", "0.1 3c x ack 00"]
)
def test_a_damaged_line_is_named(line: str) -> None:
    assert not log.is_line(line)
    with pytest.raises(ValueError, match="line 2 is none of a log"):
        list(log.read([(1, "0.1 3c w ack 00"), (2, line)]))
