"""The firmware itself, on an emulated ATmega328P, driven by the real host side in simulated time."""

from __future__ import annotations

import random
import re
import shutil
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from c_core import FIRMWARE
from emulated import HZ, Board, BoardPort, built
from simulated import Noise, whole

from firmware_protocol import DeviceResetError, Fault, HostLink, NoDeviceError, PanelFaultError, VersionError
from firmware_protocol.device import UNO
from firmware_protocol.frames import FrameDecoder
from firmware_protocol.messages import Ack, Byte, Hello, HelloReply, Message, Nak, Poll, Status, decode, encode

HELLO = b"\0" + encode(Hello(0x01020304))


@pytest.fixture
def board(binaries: tuple[Path, Path]) -> Iterator[Board]:
    board = Board(*binaries)
    board.run(HZ // 20)
    yield board
    board.close()


def joined(board: Board, baudrate: int | None = None, **options) -> tuple[BoardPort, HostLink]:
    port = BoardPort(board, **options)
    return port, HostLink(port, baudrate=baudrate, clock=port.clock)


def screens(count: int) -> list[bytes]:
    rng = random.Random(2)
    return [rng.randbytes(1024) for _ in range(count)]


def exchange(board: Board, data: bytes, rate: int = 115200) -> bytes:
    """Send bytes and return what comes back: 12 ms let the longest work be done and the longest answer through."""
    board.feed(data, rate)
    board.run(board.cycle + round((len(data) / 11520 + 0.012) * HZ))
    return board.output(rate)


def test_the_limits_of_an_uno(binaries: tuple[Path, Path]) -> None:
    if not shutil.which("avr-size"):
        pytest.skip("avr-size is not installed")
    sizes = subprocess.run(["avr-size", str(binaries[1])], capture_output=True, text=True, check=True).stdout
    text, data, bss = map(int, sizes.splitlines()[1].split()[:3])
    assert text + data < 8192
    assert data + bss - UNO.store < 800
    assert binaries[1].with_suffix(".hex").read_text().endswith(":00000001FF\n")


def test_it_says_who_it_is_after_a_start(board: Board) -> None:
    (boot,) = FrameDecoder().feed(board.output(115200))
    assert boot is not None
    assert decode(boot).cause == 1
    port, link = joined(board)
    said = link.device
    assert (said.controller, said.width, said.height, said.address, said.present) == ("ssd1306", 128, 64, 0x3C, True)
    assert link.baudrate == 500_000
    assert port.panel.ram == bytes(1024)


@pytest.mark.parametrize(("baudrate", "least"), [(115_200, 10.5), (500_000, 33.0)])
def test_random_pictures_in_simulated_frames_a_second(board: Board, baudrate: int, least: float) -> None:
    port, link = joined(board, baudrate)
    pictures = screens(6)
    link.write(whole(pictures[0]))
    start = port.clock()
    for picture in pictures:
        link.write([(True, picture)])
    assert len(pictures) / (port.clock() - start) > least
    assert link.stats.resent == board.overruns == 0


def test_one_pixel_in_simulated_time_and_bytes(board: Board) -> None:
    port, link = joined(board, 500_000)
    sent, start = link.stats.bytes_sent, port.clock()
    link.write([(False, bytes.fromhex("b00810")), (True, b"\xff")])
    assert link.stats.bytes_sent - sent <= 13
    assert port.clock() - start < 0.0015


@pytest.mark.parametrize("baudrate", [115_200, 250_000, 500_000, 1_000_000])
def test_pictures_arrive_at_every_rate(board: Board, baudrate: int) -> None:
    port, link = joined(board, baudrate)
    for picture in [*screens(2), bytes(1024), b"\x0f" * 1024]:
        link.write(whole(picture))
        port.read()
        assert port.panel.ram == picture
    seen = link.status()
    assert seen.overflows == board.overruns == link.stats.resent == 0
    assert board.untouched_ram > 500


@pytest.mark.parametrize("baudrate", [115_200, 500_000])
def test_a_noisy_line_costs_bytes_and_no_picture(board: Board, baudrate: int) -> None:
    port, link = joined(board, baudrate, noise=Noise(0.001, 0.001, 0.001), seed=4)
    pictures = screens(6)
    before = port.carried
    for picture in pictures:
        link.write(whole(picture))
        port.read()
        assert port.panel.ram == picture
    assert link.stats.resent > 0
    assert (port.carried - before) / len(pictures) < 2.2 * 1180


def conversations() -> dict[str, list[str]]:
    text = (FIRMWARE.parent / "vectors" / "conversations.txt").read_text()
    return {name: lines for name, *lines in (part.splitlines() for part in text.split("# ")[1:])}


@pytest.fixture(scope="module")
def boards(binaries: tuple[Path, Path]) -> Callable[[str], tuple[Path, Path]]:
    """The firmware as built for one kind of device or another."""
    options = {"control-each": "-DPD_CONTROL_EACH=1", "no-repeats": "-DPD_REPEATS=0"}

    def board(kind: str) -> tuple[Path, Path]:
        return built(options[kind]) if kind in options else binaries

    return board


def happens(board: Board, what: str) -> None:
    name, _, value = what.partition(" ")
    if name == "start":
        board.reset()
        board.run(board.cycle + HZ // 20)
    elif name == "wait":
        board.run(board.cycle + int(value) * HZ // 1000)
    elif name == "reads":
        board.gives(int(value, 16))
    else:
        board.panel(absent=name == "gone")


#: They take seconds of the board's time; of some kind there is another that does not, and the core has them all.
LONG = {"numbers wrap", "no repeats", "another rate and back", "a host that came back at the first rate"}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.thorough) if name in LONG else name for name in conversations()]
)
def test_the_golden_conversations(boards: Callable[[str], tuple[Path, Path]], name: str) -> None:
    lines = conversations()[name]
    board = Board(*boards(lines[0][2:]))
    board.run(HZ // 20)
    board.output(115200)
    replies, written, wanted, wanted_written, rate = b"", [], b"", [], 115200
    for line in lines:
        mark, _, content = line.partition(" ")
        if mark == "!":
            happens(board, content)
            replies += board.output(rate)
        elif mark == ">":
            replies += exchange(board, bytes.fromhex(content), rate)
            written += board.transactions()
        elif mark in "<~":
            wanted += bytes.fromhex(content)
        elif mark == "=":
            wanted_written.append(bytes.fromhex(content))
        elif mark == "@":
            rate = int(content)
    assert comparable(replies) == comparable(wanted)
    assert written == wanted_written
    board.close()


def comparable(replies: bytes) -> list[object]:
    """Leave out what one device says otherwise than another: its name, its start and its line's counters."""
    found: list[object] = []
    for frame in FrameDecoder().feed(replies):
        assert frame is not None
        message = decode(frame)
        if isinstance(message, HelloReply):
            limits = message.repeats, message.max_payload, message.window, message.store
            found.append((message.nonce, message.version, message.present, message.features, *limits))
        elif isinstance(message, Status):
            found.append((message.token, message.expected, message.fault, message.damaged))
        else:
            found.append(message if isinstance(message, Ack | Nak | Byte) else type(message))
    return found


@pytest.mark.parametrize(
    ("trouble", "cause"),
    [(lambda b: b.reset(), "reset pin"), (lambda b: b.reset(power=True), "power on"), (lambda b: b.hang(), "watchdog")],
)
@pytest.mark.parametrize("baudrate", [115_200, pytest.param(500_000, marks=pytest.mark.thorough)])
def test_a_restart_in_the_middle(board: Board, trouble: Callable[[Board], None], cause: str, baudrate: int) -> None:
    port, link = joined(board, baudrate)
    first, second = screens(2)
    link.submit(whole(first))
    trouble(board)
    with pytest.raises(DeviceResetError, match=cause):
        link.write(whole(first))
    link.write(whole(second))
    port.read()
    assert port.panel.ram == second
    assert link.stats.sessions == 2


@pytest.mark.parametrize("resets", [20, pytest.param(260, marks=pytest.mark.thorough)])
def test_each_start_has_another_number_and_a_loop_of_resets_spares_the_eeprom(board: Board, resets: int) -> None:
    held: list[tuple[int, bytes]] = []
    for trouble in ["first", *["reset"] * 3, "hang", "power", *["reset"] * resets, "power", "power", "hang", "reset"]:
        if trouble == "hang":
            board.hang()
            board.run(board.cycle + HZ)
        elif trouble != "first":
            board.reset(power=trouble == "power")
            board.run(board.cycle + HZ // 20)
        *_, frame = FrameDecoder().feed(board.output(115200))
        assert frame is not None
        boot, eeprom = decode(frame).boot, board.eeprom
        if held:
            assert boot != held[-1][0]
            assert (eeprom != held[-1][1]) == (trouble == "power")
        held.append((boot, eeprom))


@pytest.mark.parametrize(
    ("panel", "fault"),
    [
        ({"absent": True}, Fault.ADDRESS_NACK),
        ({"nack_after": 200}, Fault.DATA_NACK),
        ({"stuck": True}, Fault.BUS_STUCK),
    ],
)
def test_a_panel_that_fails_and_comes_back(board: Board, panel: dict[str, int], fault: Fault) -> None:
    port, link = joined(board)
    board.panel(**panel)
    with pytest.raises(PanelFaultError) as caught:
        link.write(whole(screens(1)[0]))
    assert caught.value.fault == fault
    board.panel()
    board.transactions()
    for picture in screens(2):
        link.write(whole(picture))
        port.read()
        assert port.panel.ram == picture
    assert link.stats.sessions == 1


def test_a_panel_that_is_not_there_is_told_at_the_handshake(board: Board) -> None:
    board.panel(absent=True)
    assert not joined(board)[1].device.present


@pytest.mark.parametrize("baudrate", [115_200, 9_600, 1_000_000])
def test_any_bytes_leave_it_ready(board: Board, baudrate: int) -> None:
    exchange(board, HELLO)
    rng = random.Random(baudrate)
    for _ in range(20):
        size = min(400, baudrate // 400)
        noise = rng.randbytes(size) if rng.random() < 0.7 else bytes(rng.choices((0, 1, 2, 0x10, 255), k=size))
        board.feed(noise, baudrate)
        board.run(board.cycle + HZ // 20)
        board.output(115200)
    board.run(board.cycle + HZ // 2)
    board.output(115200)
    kinds = [frame.kind for frame in FrameDecoder().feed(exchange(board, HELLO + encode(Poll(1)))) if frame]
    assert kinds[-2:] == [0x81, 0x82]
    assert board.untouched_ram > 500  # neither the stack nor a stray write came there


def test_acknowledgements_twice_late_and_out_of_order_do_no_harm(board: Board) -> None:
    port, link = joined(board)
    held: list[bytes] = []
    output = board.output

    def shuffled(baudrate: int) -> bytes:
        held.extend(bytes((byte,)) for byte in output(baudrate))
        frames = [part + b"\0" for part in b"".join(held).split(b"\0")]
        held[:] = [frames.pop()[:-1]]
        return b"".join(frame * 2 for frame in reversed(frames))

    board.output = shuffled  # type: ignore[method-assign]
    for picture in screens(4):
        link.write(whole(picture))
        port.read()
        assert port.panel.ram == picture


def test_more_than_the_window_is_lost_and_nothing_else(board: Board) -> None:
    port, link = joined(board, 500_000)
    port.write(b"\0" + bytes(range(1, 256)) * 40)
    picture = screens(1)[0]
    link.write(whole(picture))
    port.read()
    assert port.panel.ram == picture


def test_a_host_that_leaves_at_a_fast_rate_finds_the_board_again(board: Board) -> None:
    joined(board, 1_000_000)
    port, link = joined(board, 115_200)
    picture = screens(1)[0]
    link.write(whole(picture))
    port.read()
    assert port.panel.ram == picture


@pytest.mark.parametrize(("oldest", "newest", "advice"), [(2, 3, "update paneldraw"), (1, 9, "")])
def test_firmware_that_is_newer(oldest: int, newest: int, advice: str) -> None:
    board = Board(*built(f"-DPD_OLDEST_VERSION={oldest} -DPD_NEWEST_VERSION={newest}"))
    board.run(HZ // 20)
    if advice:
        with pytest.raises(VersionError, match=advice):
            joined(board)
    else:
        assert joined(board)[1].device.version == 1
    board.close()


def test_firmware_that_is_older(board: Board, monkeypatch: pytest.MonkeyPatch) -> None:
    def newer(message: Message) -> bytes:
        return encode(Hello(message.nonce, 2, 3) if isinstance(message, Hello) else message)

    monkeypatch.setattr("firmware_protocol.link.encode", newer)
    monkeypatch.setattr("firmware_protocol.link.OLDEST_VERSION", 2)
    monkeypatch.setattr("firmware_protocol.link.NEWEST_VERSION", 3)
    with pytest.raises(VersionError, match=r"speaks protocol versions 1 to 1, .* 2 to 3: update the board's firmware"):
        joined(board)
    monkeypatch.undo()
    assert joined(board)[1].device.version == 1


@pytest.mark.parametrize("factor", [0.9, *(pytest.param(factor, marks=pytest.mark.thorough) for factor in (0.5, 2.0))])
def test_a_line_at_another_rate_than_the_host_believes(board: Board, factor: float) -> None:
    """The host's adapter has the wrong clock, or the board the wrong crystal."""
    feed, output = board.feed, board.output
    board.feed = lambda data, baudrate: feed(data, round(baudrate * factor))  # type: ignore[method-assign]
    board.output = lambda baudrate: output(round(baudrate * factor))  # type: ignore[method-assign]
    with pytest.raises(NoDeviceError, match="at 115200 baud: check the port"):
        joined(board)
    board.feed, board.output = feed, output  # type: ignore[method-assign]
    port, link = joined(board)
    picture = screens(1)[0]
    link.write(whole(picture))
    port.read()
    assert port.panel.ram == picture


def test_the_builds_of_the_readme() -> None:
    text = (FIRMWARE / "README.md").read_text()
    (options,) = re.findall(r"`OPTIONS=(\S+)`", text)
    builds = re.findall(r"^    make -C firmware_protocol/firmware atmega328p(.*)", text, re.MULTILINE)
    made = []
    for build in builds:
        settings = dict(setting.split("=") for setting in build.split())
        board = Board(*built(options, **settings))
        board.run(HZ // 20)
        said = joined(board)[1].device
        made.append((said.bus.name, said.address, said.controller, said.width, said.height))
        board.close()
    assert made == [
        ("I2C", 0x3D, "ssd1306", 128, 64),
        ("I2C", 0x3D, "sh1106", 128, 64),
        ("SPI", 0, "ssd1322", 256, 64),
        ("SPI", 0, "max7219", 64, 8),
    ]


def test_the_readme_names_the_files_that_are_made() -> None:
    text = (FIRMWARE / "README.md").read_text()
    assert re.search(r"firmware flash .*--file .*build/atmega328p/paneldraw\.hex", text)
