"""The pages for those who come from others: their scripts run as printed, and need the bytes that are printed."""

from __future__ import annotations

import gzip
import re
import sys
import types
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import pytest
import smbus2
from blinka import Busio

from paneldraw import Framebuffer, Panel, simulator
from paneldraw.pacing import Frames

PAGES = Path(__file__).parents[2] / "docs" / "coming_from"
LOGS = Path(__file__).parents[1] / "golden"
NAMES = sorted(page.stem for page in PAGES.glob("*.md"))


def text_of(page: str) -> str:
    return (PAGES / f"{page}.md").read_text("utf-8")


def scripts(page: str) -> list[str]:
    """The blocks of Python of the page's whole script, in order."""
    section = re.search(r"^## A whole script\n(.*?)^## ", text_of(page), re.DOTALL | re.MULTILINE)
    assert section
    return re.findall(r"```python\n(.*?)```", section[1], re.DOTALL)


def printed(page: str) -> list[int]:
    found = re.findall(r"^\| \S.* \| ([\d,]+) \| ", text_of(page), re.MULTILINE)
    return [int(number.replace(",", "")) for number in found]


class Shown(NamedTuple):
    """What a script leaves on the glass, and the bytes it sent."""

    pixels: npt.NDArray[np.uint8]
    bytes: int


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], Shown]:
    """Run a script as printed on a simulated SSD1306, in no time."""
    clock = [0.0]

    def sleep(seconds: float) -> None:
        clock[0] += max(seconds, 0)

    monkeypatch.setattr("time.sleep", sleep)
    monkeypatch.setattr(Panel, "frames", lambda panel, fps: Frames(fps, clock=lambda: clock[0], sleep=sleep))
    monkeypatch.setattr("time.perf_counter", lambda: clock[0])
    monkeypatch.setattr("time.monotonic", lambda: clock[0])
    # Their script's end must not clear a panel that is not there any more.
    monkeypatch.setattr("atexit.register", lambda *arguments: None)

    def shown(script: str) -> Shown:
        chip = simulator.SSD1306(128, 64)
        bus = simulator.I2CBus({0x3C: chip}, timer=None)
        monkeypatch.setattr(smbus2, "SMBus", lambda *path: bus)
        board = types.ModuleType("board")
        vars(board)["I2C"] = lambda: Busio(bus)
        monkeypatch.setitem(sys.modules, "board", board)
        names: dict[str, Any] = {}  # what it holds is alive as long as the glass is looked at
        exec(script, names)
        return Shown(chip.pixels.copy(), bus.bytes)

    return shown


def replayed(name: str) -> Shown:
    """What a log leaves on the glass, and its bytes."""
    path = LOGS / f"{name}.log.gz"
    chip = simulator.SSD1306(128, 64)
    simulator.replay(path, chip)
    with gzip.open(path, "rt") as log:
        payloads = [line.split()[-1] for line in log if not line.startswith("#")]
    return Shown(chip.pixels, sum(1 + len(payload) // 2 for payload in payloads))


@pytest.mark.filterwarnings("ignore:Image.Image.getdata is deprecated")
@pytest.mark.parametrize("page", ["luma", "adafruit"])
def test_scripts_show_the_same_with_the_bytes_that_are_printed(page: str, run: Callable[[str], Shown]) -> None:
    before, after, own = map(run, scripts(page))
    assert np.array_equal(before.pixels, after.pixels)
    assert (before.pixels != own.pixels).mean() < 0.01  # of two equally near pixels each takes its own
    assert printed(page) == [before.bytes, after.bytes]


def test_only_the_imports_differ() -> None:
    for page in ("luma", "adafruit"):
        before, after = (
            [line for line in block.splitlines() if not re.match(r"(from|import) .*(luma|adafruit)", line)]
            for block in scripts(page)[:2]
        )
        assert before == after


@pytest.fixture
def displayio() -> Iterator[None]:
    """Blinka's displayio, without the thread that it starts."""
    module = pytest.importorskip("displayio")
    pytest.importorskip("adafruit_displayio_ssd1306")
    module.background_thread_stop_event.set()
    yield
    module.release_displays()


@pytest.mark.usefixtures("displayio")
def test_displayio_and_paneldraw_show_the_same(run: Callable[[str], Shown]) -> None:
    before, after = map(run, scripts("displayio"))
    assert np.array_equal(before.pixels, after.pixels)
    assert before.pixels.sum() > 400
    assert printed("displayio") == [before.bytes, after.bytes]


@pytest.mark.parametrize(("page", "log"), [("u8g2", "u8g2"), ("micropython", "micropython_ssd1306")])
def test_paneldraw_shows_what_a_log_of_theirs_shows(page: str, log: str, run: Callable[[str], Shown]) -> None:
    before, after = replayed(log), run(scripts(page)[-1])
    assert np.array_equal(before.pixels, after.pixels)
    assert before.pixels.sum() > 1000
    assert printed(page) == [before.bytes, after.bytes]


@pytest.mark.parametrize("page", NAMES)
def test_the_calls_that_a_page_names_exist(page: str) -> None:
    text = text_of(page)
    for name in re.findall(r"`fb\.(\w+)", text):
        assert hasattr(Framebuffer, name), name
    for name in re.findall(r"`panel\.(\w+)", text):
        assert hasattr(Panel, name) or name in {"stats", "simulated"}, name


def test_the_page_names_all_chips_of_luma_s_face() -> None:
    from paneldraw.compat.luma.core import cmdline

    text = text_of("luma")
    for names in cmdline.get_display_types().values():
        for name in names:
            assert re.search(rf"\b{name.upper()}\b", text), name
