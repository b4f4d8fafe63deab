"""The kernel's side of spidev and of GPIO lines, call by call, as its source has it; of i2c-dev: tests/transports."""

from __future__ import annotations

import errno
import struct
from collections.abc import Callable

import pytest

from paneldraw import simulator
from paneldraw.simulator.kernel.gpio import LINES, GPIOChip, GPIOLines, SysfsLines
from paneldraw.simulator.kernel.spidev import SPIFile

READ, WRITE = 0x80000000, 0x40000000
MODE, BITS, SPEED, MODE32 = 0x016B01, 0x016B03, 0x046B04, 0x046B05
LSB_FIRST = 0x016B02
GET_LINE, SET_VALUES, GET_VALUES, SET_CONFIG = 0xC250B407, 0xC010B40F, 0xC010B40E, 0xC110B40D


def code(call: Callable[..., object], *arguments: object) -> int:
    with pytest.raises(OSError) as caught:  # noqa: PT011
        call(*arguments)
    return caught.value.errno or 0


@pytest.fixture
def bus() -> simulator.SPIBus:
    return simulator.SPIBus(simulator.SSD1306(), timer=None)


def message(*transfers: tuple[int, bytes | None, bool], changes: int = 0) -> tuple[int, int, bytes]:
    """A SPI_IOC_MESSAGE as the C library packs it: length, bytes to send, whether an answer is wanted."""
    heads = [struct.pack("=IIHBBBB", n, 0, 0, 0, changes, sent is not None, wanted) for n, sent, wanted in transfers]
    sent = [sent for _, sent, _ in transfers if sent]
    request = WRITE | 32 * len(transfers) << 16 | 0x6B00
    return request, 0, struct.pack("=I", len(transfers)) + b"".join(heads + sent)


@pytest.mark.parametrize(
    ("request_", "value"), [(MODE, 3), (MODE, 0x44), (MODE32, 0x40), (BITS, 8), (SPEED, 1_234_567), (LSB_FIRST, 0)]
)
def test_spi_settings_are_read_back(bus: simulator.SPIBus, request_: int, value: int) -> None:
    size = request_ >> 16
    assert SPIFile(bus).ioctl(WRITE | request_, 0, value.to_bytes(size, "little")) == (0, b"")
    assert SPIFile(bus).ioctl(READ | request_, 0, b"") == (0, value.to_bytes(size, "little"))


@pytest.mark.parametrize(("request_", "value"), [(MODE, 0x08), (MODE32, 0x100), (BITS, 9), (SPEED, 0), (LSB_FIRST, 1)])
def test_spi_settings_that_the_adapter_does_not_take(bus: simulator.SPIBus, request_: int, value: int) -> None:
    assert code(SPIFile(bus).ioctl, WRITE | request_, 0, value.to_bytes(request_ >> 16, "little")) == errno.EINVAL


def test_spi_limits(bus: simulator.SPIBus) -> None:
    file = SPIFile(bus)
    assert file.write(bytes(4096)) == 4096
    assert code(file.write, bytes(4097)) == errno.EMSGSIZE
    assert file.read(3) == bytes(3)
    assert code(file.read, 4097) == errno.EMSGSIZE
    assert file.write(b"") == 0
    half = (4096, bytes(4096), False)
    assert code(file.ioctl, *message(half, (1, b"x", False))) == errno.EMSGSIZE
    assert file.ioctl(*message(half, (4096, None, True))) == (8192, bytes(4096))
    assert file.ioctl(WRITE | 0x6B00, 0, b"") == (0, b"")
    assert code(file.ioctl, WRITE | 33 << 16 | 0x6B00, 0, b"") == errno.EINVAL
    assert code(file.ioctl, WRITE | 0x016B06, 0, b"x") == errno.ENOTTY
    assert code(file.ioctl, 0x0703, 0x3C, b"") == errno.ENOTTY


@pytest.mark.parametrize(("changes", "selects"), [(0, 1), (1, 2)])
def test_a_spi_message_is_one_chip_select_unless_it_says_otherwise(
    bus: simulator.SPIBus, changes: int, selects: int
) -> None:
    SPIFile(bus).ioctl(*message((1, b"\x81", False), (1, b"\x22", False), changes=changes))
    assert bus.messages == selects
    assert bus.chips[0].contrast == 0x22  # type: ignore[attr-defined]


def line_request(*numbers: int, flags: int = 8, values: int = 0) -> bytes:
    """A gpio_v2_line_request."""
    offsets = struct.pack("=64I", *numbers, *[0] * (64 - len(numbers)))
    attribute = struct.pack("=IIQQ", 2, 0, values, (1 << len(numbers)) - 1) if values else b""
    config = struct.pack("=QI20x", flags, bool(values)) + attribute.ljust(240, b"\0")
    return (offsets + b"me".ljust(32, b"\0") + config + struct.pack("=I", len(numbers))).ljust(592, b"\0")


def test_gpio_lines_drive_the_bus_and_are_held(bus: simulator.SPIBus) -> None:
    chip = GPIOChip([bus])
    held = chip.claim(GET_LINE, line_request(25, 24, values=0b01))
    assert (bus.pins.get(25), bus.pins.get(24)) == (True, False)
    held.ioctl(SET_VALUES, 0, struct.pack("=QQ", 0b10, 0b11))
    assert (bus.pins.get(25), bus.pins.get(24)) == (False, True)
    assert held.ioctl(GET_VALUES, 0, struct.pack("=QQ", 0, 0b11)) == (0, struct.pack("=QQ", 0b10, 0b11))
    assert code(chip.claim, GET_LINE, line_request(24)) == errno.EBUSY
    assert chip.lines[24].consumer == b"me"
    held.close()
    assert bus.pins.get(24), "a line that is let go keeps its level"
    assert isinstance(chip.claim(GET_LINE, line_request(24)), GPIOLines)


def test_gpio_lines_that_are_active_low(bus: simulator.SPIBus) -> None:
    held = GPIOChip([bus]).claim(GET_LINE, line_request(24, flags=8 | 2, values=1))
    assert not bus.pins.get(24)
    held.ioctl(SET_VALUES, 0, struct.pack("=QQ", 0, 1))
    assert bus.pins.get(24)


def test_gpio_requests_that_the_kernel_refuses(bus: simulator.SPIBus) -> None:
    chip = GPIOChip([bus])
    for bad in (line_request(), line_request(LINES), line_request(3, flags=4 | 8)):
        assert code(chip.claim, GET_LINE, bad) == errno.EINVAL
    assert code(chip.claim, GET_LINE, line_request(3, 3)) == errno.EBUSY
    assert code(chip.ioctl, 0xC100B405, 0, bytes(64) + struct.pack("=I", LINES) + bytes(188)) == errno.EINVAL
    held = chip.claim(GET_LINE, line_request(3, flags=4))
    assert code(held.ioctl, SET_VALUES, 0, struct.pack("=QQ", 1, 1)) == errno.EPERM
    assert code(held.ioctl, GET_VALUES, 0, struct.pack("=QQ", 0, 0)) == errno.EINVAL
    assert code(held.ioctl, GET_LINE, 0, b"") == errno.ENOTTY
    held.ioctl(SET_CONFIG, 0, line_request(3, flags=8)[288:560])
    held.ioctl(SET_VALUES, 0, struct.pack("=QQ", 1, 1))
    assert chip.lines[3].high


def test_lines_in_sysfs() -> None:
    seen: list[tuple[int, bool]] = []
    lines = SysfsLines(GPIOChip(), lambda number, there: seen.append((number, there)))
    assert code(lines.open, "gpio7/value") == errno.ENOENT
    lines.open("export").write(b"7\n")
    assert code(lines.open("export").write, b"7") == errno.EBUSY
    assert code(lines.open("export").write, b"seven") == errno.EINVAL
    value = lines.open("gpio7/value")
    assert code(value.write, b"1") == errno.EPERM
    assert code(lines.open("gpio7/direction").write, b"up") == errno.EINVAL
    lines.open("gpio7/direction").write(b"high")
    assert (value.read(10), value.read(10)) == (b"1\n", b"")
    lines.open("unexport").write(b"7")
    assert code(lines.open("unexport").write, b"7") == errno.EINVAL
    assert seen == [(7, True), (7, False)]
