"""The firmware's SPI build on an emulated ATmega328P: what a panel on its pins sees, byte by byte and line by line."""

from __future__ import annotations

import random
import shutil
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from emulated import HZ, Board, BoardPort, Recorder, built
from simulated import Noise

from firmware_protocol import DeviceResetError, Fault, HostLink, PanelFaultError
from firmware_protocol.device import UNO
from firmware_protocol.messages import Kind, PanelBus

Select = list[tuple[bool, bytes]]
SIZES = {"ssd1322": (256, 64), "sh1106": (128, 64), "pcd8544": (84, 48), "max7219": (32, 8)}


@pytest.fixture(scope="module")
def binaries() -> tuple[Path, Path]:
    return built(BUS="spi", CHIP="ssd1322")


@pytest.fixture
def board(binaries: tuple[Path, Path]) -> Iterator[Board]:
    board = Board(*binaries)
    board.run(HZ // 20)
    yield board
    board.close()


def joined(board: Board, baudrate: int | None = None, **options) -> tuple[Recorder, HostLink]:
    port = BoardPort(board, **options)
    recorder = Recorder()
    port.spi = recorder
    return recorder, HostLink(port, baudrate=baudrate, clock=port.clock)


def taken(recorder: Recorder, link: HostLink) -> list[Select]:
    """Return the chip selects since the last look."""
    link.status()
    selects = recorder.selects[:]
    recorder.selects.clear()
    assert recorder.open == []
    return selects


def flat(selects: list[Select], kind: bool) -> bytes:
    return b"".join(content for select in selects for is_data, content in select if is_data == kind)


@pytest.mark.parametrize("chip", SIZES)
def test_it_says_which_panel_it_drives_within_the_limits_of_an_uno(chip: str) -> None:
    binaries = built(BUS="spi", CHIP=chip)
    board = Board(*binaries)
    board.run(HZ // 20)
    said = joined(board)[1].device
    assert (said.controller, said.width, said.height) == (chip, *SIZES[chip])
    assert (said.bus, said.address, said.acknowledges, said.present) == (PanelBus.SPI, 0, False, True)
    assert said.reset_line
    board.close()
    if shutil.which("avr-size"):
        sizes = subprocess.run(["avr-size", str(binaries[1])], capture_output=True, text=True, check=True).stdout
        text, data, bss = map(int, sizes.splitlines()[1].split()[:3])
        assert text + data < 8192
        assert data + bss - UNO.store < 800


def test_a_chain_of_another_length() -> None:
    board = Board(*built(BUS="spi", CHIP="max7219", SIZE="64x8"))
    board.run(HZ // 20)
    said = joined(board)[1].device
    assert (said.controller, said.width, said.height) == ("max7219", 64, 8)
    board.close()


def test_a_message_is_a_chip_select_with_its_kind_on_the_dc_line(board: Board) -> None:
    recorder, link = joined(board)
    link.write([(False, b"\x15"), (True, b"\x1c\x5b"), (False, b"\x75\xae"), (True, bytes(200)), (False, b"\xaf")])
    assert taken(recorder, link) == [
        [(False, b"\x15")],
        [(True, b"\x1c\x5b")],
        [(False, b"\x75\xae")],
        [(True, bytes(200))],
        [(False, b"\xaf")],
    ]
    assert board.spi_clock == 4_000_000


@pytest.mark.parametrize("modules", [1, 8, 60])
@pytest.mark.parametrize("kind", [False, True])
@pytest.mark.parametrize("noise", [0.0, 0.003])
def test_messages_of_one_kind_to_a_chain_stay_whole_and_apart(
    board: Board, modules: int, kind: bool, noise: float
) -> None:
    recorder, link = joined(board, noise=Noise(noise, noise, noise), seed=modules)
    rng = random.Random(modules)
    for _ in range(8 if noise else 2):
        rows = [b"".join(bytes((row, rng.randrange(256))) for _ in range(modules)) for row in range(1, 9)]
        rows[3:5] = [b"\x04\0" * modules, b"\x04\0" * modules]
        link.write([(kind, row) for row in rows])
        assert taken(recorder, link) == [[(kind, row)] for row in rows]
    assert (link.stats.resent > 0) == (noise > 0)


@pytest.mark.parametrize(("baudrate", "least"), [(115_200, 10.5), (500_000, 43.0), (1_000_000, 60.0)])
def test_random_kilobytes_in_simulated_pictures_a_second(board: Board, baudrate: int, least: float) -> None:
    recorder, link = joined(board, baudrate)
    rng = random.Random(2)
    pictures = [rng.randbytes(1024) for _ in range(6)]
    link.status()
    start = link.clock()
    for picture in pictures:
        link.write([(False, b"\x5c"), (True, picture)])
    assert len(pictures) / (link.clock() - start) > least
    selects = taken(recorder, link)
    assert flat(selects, True) == b"".join(pictures)
    assert flat(selects, False) == b"\x5c" * 6
    assert link.stats.resent == board.overruns == 0
    assert board.untouched_ram > 500


def test_the_longest_frame_keeps_neither_the_watchdog_nor_the_line_waiting(board: Board) -> None:
    recorder, link = joined(board, 500_000)
    payload = b"\xc0\x00" * 125
    start = link.clock()
    link._sequenced(Kind.WRITE, payload)
    assert link.clock() - start < 0.06
    for _ in range(40):
        link._sequenced(Kind.WRITE, payload)
    assert flat(taken(recorder, link), True) == bytes(41 * 125 * 65)
    assert link.stats.sessions == 1
    assert link.status().overflows == board.overruns == 0


def test_the_reset_line_is_pulled_at_each_start_and_when_asked(board: Board) -> None:
    assert board.wire() == [("r", b"\x0a")]  # for 10 ms, and nothing else has moved
    recorder, link = joined(board)
    link.reset_panel()
    assert taken(recorder, link) == []
    assert recorder.resets == 1


@pytest.mark.parametrize("trouble", [lambda b: b.reset(), lambda b: b.reset(power=True), lambda b: b.hang()])
def test_a_restart_in_the_middle(board: Board, trouble: Callable[[Board], None]) -> None:
    recorder, link = joined(board)
    picture = random.Random(3).randbytes(1024)
    link.submit([(True, picture)])
    resets = recorder.resets
    trouble(board)
    with pytest.raises(DeviceResetError):
        link.write([(True, picture)])
    link.status()
    assert recorder.resets == resets + 1
    recorder.selects.clear()
    link.write([(False, b"\x5c"), (True, picture)])
    assert flat(taken(recorder, link), True) == picture
    assert link.stats.sessions == 2


def test_an_spi_that_stops_is_a_fault_and_comes_back(board: Board) -> None:
    recorder, link = joined(board)
    board.panel(stuck=True)
    with pytest.raises(PanelFaultError) as caught:
        link.write([(False, b"\xaf"), (True, bytes(range(100)))])
    assert caught.value.fault == Fault.BUS_STUCK
    board.panel()
    assert flat(taken(recorder, link), False) == b""
    link.write([(False, b"\xaf"), (True, b"\x01\x02")])
    assert taken(recorder, link) == [[(False, b"\xaf")], [(True, b"\x01\x02")]]
    assert link.stats.sessions == 1
