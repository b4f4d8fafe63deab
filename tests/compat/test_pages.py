"""The pages for those who come from others: their scripts run as printed, and need the bytes that are printed."""

from __future__ import annotations

import re
import sys
import types
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import smbus2
from blinka import Busio

from paneldraw import simulator

DOCS = Path(__file__).parents[2] / "docs"


def shown(script: str, monkeypatch: pytest.MonkeyPatch) -> tuple[Any, int]:
    """Run a script as printed; return the pixels it leaves and the bytes it sent."""
    chip = simulator.SSD1306(128, 64)
    bus = simulator.I2CBus({0x3C: chip}, timer=None)
    monkeypatch.setattr(smbus2, "SMBus", lambda *path: bus)
    board = types.ModuleType("board")
    vars(board)["I2C"] = lambda: Busio(bus)
    monkeypatch.setitem(sys.modules, "board", board)
    # Their script's end must not clear a panel that is not there any more.
    monkeypatch.setattr("atexit.register", lambda *arguments: None)
    names: dict[str, Any] = {}
    exec(script, names)
    return chip.pixels.copy(), bus.bytes


@pytest.mark.filterwarnings("ignore:Image.Image.getdata is deprecated")
@pytest.mark.parametrize("page", ["from_luma.md", "from_adafruit.md"])
def test_scripts_show_the_same_with_the_bytes_that_are_printed(page: str, monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [0.0]
    monkeypatch.setattr("time.sleep", lambda seconds: clock.append(clock.pop() + max(seconds, 0)))
    monkeypatch.setattr("time.perf_counter", lambda: clock[0])
    monkeypatch.setattr("time.monotonic", lambda: clock[0])
    text = (DOCS / page).read_text("utf-8")
    before, after, own = (shown(script, monkeypatch) for script in re.findall(r"```python\n(.*?)```", text, re.DOTALL))
    assert np.array_equal(before[0], after[0])
    assert (before[0] != own[0]).mean() < 0.01  # of two equally near pixels each takes its own
    printed = [int(number.replace(",", "")) for number in re.findall(r"^\| \S.* \| ([\d,]+) \| ", text, re.MULTILINE)]
    assert printed == [before[1], after[1]]


def test_only_the_imports_differ() -> None:
    for page in ("from_luma.md", "from_adafruit.md"):
        blocks = re.findall(r"```python\n(.*?)```", (DOCS / page).read_text("utf-8"), re.DOTALL)
        before, after = (
            [line for line in block.splitlines() if not re.match(r"(from|import) .*(luma|adafruit)", line)]
            for block in blocks[:2]
        )
        assert before == after


def test_the_page_names_all_chips_of_luma_s_face() -> None:
    from paneldraw.compat.luma.core import cmdline

    text = (DOCS / "from_luma.md").read_text("utf-8")
    for names in cmdline.get_display_types().values():
        for name in names:
            assert re.search(rf"\b{name.upper()}\b", text), name
