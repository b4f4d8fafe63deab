"""A test card in steps, by which a person with the panel in hand finds what it is wired like and what it obeys."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from paneldraw.raster.coverage import Supersample
from paneldraw.transports.base import CHAINED, DATA, Plan

if TYPE_CHECKING:
    from paneldraw.framebuffer import Framebuffer
    from paneldraw.panel import Panel

#: What may be wrong with the first picture, what to try then, by the key to press.
SYMPTOMS = {
    "s": ("shifted by some columns, or noise along an edge", "chip=sh1106, or column_offset=2 (or 0, 4, 28, 32)"),
    "l": ("every other line, or lines twice as high", "size=128x32, or com_pins=0x02 or 0x12"),
    "m": ("mirrored", "mirror_x=1"),
    "u": ("upside down", "rotate=180; where it is mirrored top to bottom, mirror_y=1"),
    "d": ("right, but dim", "internal_reference=1, or contrast=255"),
    "n": ("nothing", "reset= with the line of the reset pin, charge_pump=1, another chip=; then the wiring"),
}


@dataclass
class Step:
    """One trick: what it is, what the glass must show, what is sent, and what the URL needs where it fails."""

    name: str
    shows: str
    send: Callable[[Panel], None]
    otherwise: str = "updates=plain"


@dataclass
class Findings:
    """What a person saw: parameters for the URL, and advice where it takes a try."""

    parameters: list[str] = field(default_factory=list)
    advice: list[str] = field(default_factory=list)


def card(fb: Framebuffer) -> None:
    """Draw the test card: a frame along the four edges, an arrow up, a step at the top left, the size."""
    fb.clear()
    fb.rect(0, 0, fb.width, fb.height)
    fb.rect(2, 2, 4, 2, fill=True)
    middle = fb.width // 2
    fb.line(middle, fb.height // 2 - 2, middle, 3)
    fb.line(middle - 3, 6, middle, 3)
    fb.line(middle + 3, 6, middle, 3)
    fb.text(f"{fb.width}x{fb.height}", middle, fb.height // 2, anchor="mt")


def steps(panel: Panel) -> Iterator[Step]:
    """Say which tricks of this chip's plans can be tried one by one."""
    pointer, window = panel.controller.pointer, panel.controller.window
    if panel.controller.packing not in ("pages", "nibbles"):
        return
    shows = "a solid bar in the upper left, and nothing else"
    if pointer is not None and pointer.column is None and panel.controller.packing == "pages":
        yield Step("the pointer stands behind the data", shows, _in_two_messages)
        yield Step("a half of the column pointer holds", shows, _with_one_half)
    if window is not None:
        yield Step("a window written to its end begins again", shows, _window_twice)
    chains = panel.controller.packing == "pages" and panel.transport.cost.chained is not None
    if pointer is not None and pointer.column is None and chains:
        yield Step("control bytes in a chain", shows, _in_a_chain, otherwise="")


def _bar(panel: Panel) -> tuple[int, int]:
    """Where the bar begins, as RAM column, and how wide its halves are."""
    return panel.controller.column_offset, min(16, panel.controller.width // 2)


def _pointed(panel: Panel, row: int, column: int) -> bytes:
    pointer = panel.controller.pointer
    mode = pointer.mode if pointer else b""
    return mode + bytes((0xB0 + row, column & 15, 0x10 + (column >> 4)))


def _in_two_messages(panel: Panel) -> None:
    column, half = _bar(panel)
    panel.transport.command(_pointed(panel, 0, column))
    panel.transport.data(b"\xff" * half)
    panel.transport.data(b"\xff" * half)


def _with_one_half(panel: Panel) -> None:
    column, half = _bar(panel)
    end = min(column + half, (column & ~15) + 15)
    panel.transport.command(_pointed(panel, 0, end))
    panel.transport.data(b"\xff" * (column + 2 * half - end))
    panel.transport.command(_pointed(panel, 0, column & ~15 | 15))
    panel.transport.command(bytes((column & 15,)))
    panel.transport.data(b"\xff" * (end - column))


def _window_twice(panel: Panel) -> None:
    """Fill a window twice: an eighth of it first, all of it from where the pointer stands then."""
    window, (wide, high) = panel.controller.window, panel.controller.cell
    if window is None:
        return
    column, half = _bar(panel)
    left, rows = column // wide, 8 // high
    columns = 2 * half // wide
    for command in (
        window.across,
        bytes((window.columns, left, left + columns - 1)),
        bytes((window.rows, panel.controller.row_offset // high, panel.controller.row_offset // high + rows - 1)),
        window.write,
    ):
        if command:
            panel._driver.command(command)
    size = columns * window.column_bytes * rows
    panel.transport.data(b"\x0f" * size)
    panel.transport.data(b"\xff" * size)


def _in_a_chain(panel: Panel) -> None:
    column, half = _bar(panel)
    pointer = _pointed(panel, 0, column)
    chain = [byte for command in pointer for byte in (CHAINED, command)][1:]
    message = bytes((CHAINED, *chain, DATA)) + b"\xff" * 2 * half
    plan = Plan(len(message), 1)
    plan.buffer[:] = np.frombuffer(message, np.uint8)
    plan.starts[0], plan.stops[0], plan.count, plan.cost = 0, len(message), 1, 1 + len(message)
    panel.transport.batch(plan)


def run(panel: Panel, show: Callable[[Panel, str], None], ask: Callable[[str], str]) -> Findings:
    """Go through the card with a person.

    Parameters
    ----------
    panel : Panel
        One with ``updates="whole"``, so that nothing of a chip is believed before it was tried.
    show : callable
        Called after each step with the panel and what its glass must show.
    ask : callable
        Asks a question; returns the answer.
    """
    found = Findings()
    fb = panel.framebuffer()
    card(fb)
    panel.show(fb)
    show(panel, "a frame along all four edges, an arrow up in the middle, a step at the top left, the size")
    keys = ", ".join(f"{key}: {symptom}" for key, (symptom, _) in SYMPTOMS.items())
    answer = ask(f"Is it so? y: yes; {keys} ")
    if answer in SYMPTOMS:
        found.advice.append(SYMPTOMS[answer][1])
        return found
    plain = True
    for step in steps(panel):
        panel.clear()
        step.send(panel)
        panel.invalidate()
        show(panel, step.shows)
        obeyed = ask(f"{step.name}: is it so? y or n ") != "n"
        if not obeyed and step.otherwise and step.otherwise not in found.parameters:
            found.parameters.append(step.otherwise)
        if obeyed and not step.otherwise:
            plain = False
    if not plain and not found.parameters:
        found.parameters.append("chained_control=1")
    _brightness(panel, fb, show, ask, found)
    return found


def greys_card(fb: Framebuffer) -> None:
    """Draw the card for greys: a bar of each level, a smooth line and a disc."""
    fb.clear()
    bars = fb.max_level + 1
    for level in range(bars):
        fb.rect(level * 4, 0, 4, 8, level, fill=True)
    x, y, radius = 3 * fb.width // 4, fb.height // 2, fb.height // 4
    fb.circle(x, y, radius, fill=True, antialias=Supersample(4))
    fb.line(4, fb.height - 8, fb.width // 2, fb.height // 2, width=2, antialias=Supersample(4))


def run_greys(
    open_greys: Callable[[int], Panel], show: Callable[[Panel, str], None], ask: Callable[[str], str]
) -> Findings:
    """Try greys, the most first, until a person sees them steady; `open_greys` opens the panel with so many."""
    found = Findings()
    for greys in (4, 3):
        with open_greys(greys) as panel:
            fb = panel.framebuffer()
            greys_card(fb)
            panel.show(fb)
            panel.flush()
            show(panel, f"bars in {greys} greys at the top left, a smooth line and a disc, all steady")
            answer = ask(f"{greys} greys: is it so? y: yes; f: it flickers; b: bands wander; n: no greys ")
        if answer == "y":
            found.parameters.append(f"greys={greys}")
            return found
        if answer == "f" and not found.advice:
            found.advice.append("a faster bus, and bus_clock= with its rate")
    return found


def _brightness(
    panel: Panel, fb: Framebuffer, show: Callable[[Panel, str], None], ask: Callable[[str], str], found: Findings
) -> None:
    if panel.controller.contrast is None:
        return
    fb.fill(fb.max_level)
    panel.show(fb)
    for level in (255, 128, 0):
        panel.contrast(level)
        show(panel, f"all pixels lit, contrast {level}")
        if ask(f"contrast {level}: keep this brightness? y or n ") == "y":
            found.parameters.append(f"contrast={level}")
            return


def ask(question: str) -> str:
    """Ask on the terminal; whatever input there is not counts as yes."""
    print(question, end="", flush=True)
    line = sys.stdin.readline()
    if not (line and sys.stdin.isatty()):
        print()
    return line.strip().lower()[:1] or "y"
