"""What some chips do by themselves and others do not: the commands for it, or an error that names the chips that do."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from paneldraw.controllers import CHIPS
from paneldraw.controllers.record import Controller, Effect, Scroll


class Box(NamedTuple):
    """Columns and rows of the glass; right and bottom are exclusive."""

    left: int
    top: int
    right: int
    bottom: int


def lacking(controller: Controller, what: str, having: Callable[[Controller], object]) -> ValueError:
    """Make the error for what a chip has not, which names the chips that have it."""
    able = ", ".join(chip.name for chip in CHIPS.values() if having(chip())) or "no chip"
    return ValueError(f"the {controller.name.upper()} cannot {what}; {able} can")


def by_itself(controller: Controller) -> list[str]:
    """Say what a chip does by itself, in words.

    Examples
    --------
    >>> from paneldraw.controllers import SSD1309
    >>> by_itself(SSD1309())
    ['scrolls across, up and down', 'scrolls some columns', 'scrolls by single steps', 'all on']
    """
    does = [name + "s" for name in ("blink", "fade") if getattr(controller, name) is not None]
    chip = controller.scroll
    if chip is not None:
        across = "scrolls across, up and down" if chip.diagonal else "scrolls across"
        columns = ["scrolls some columns"] if "{left}" in chip.across else []
        does = [across, *columns, *(["scrolls by single steps"] if chip.once else []), *does]
    return [*does, *(["all on"] if controller.all_on else [])]


def effect(controller: Controller, name: str) -> Effect:
    """Return an effect, ``"blink"`` or ``"fade"``, of a chip that has it."""
    found: Effect | None = getattr(controller, name)
    if found is None:
        raise lacking(controller, f"{name} by itself", lambda chip: getattr(chip, name))
    return found


def scroll(controller: Controller, dx: int, dy: int, frames: float, box: Box) -> tuple[bytes, ...]:
    """Return the commands that make a box of the glass move, again and again."""
    chip = _scroll(controller, dx, dy)
    if not frames > 0:
        raise ValueError(f"frames must be above 0, not {frames!r}")
    speed = min(range(len(chip.frames)), key=lambda code: abs(chip.frames[code] - frames))
    way = chip.diagonal if dy else chip.across
    if dy and not way:
        raise lacking(controller, "scroll up or down", lambda other: other.scroll and other.scroll.diagonal)
    if dy and not dx and "{columns}" not in way:
        raise lacking(
            controller,
            "scroll up or down alone, without left or right",
            lambda other: other.scroll and "{columns}" in other.scroll.diagonal,
        )
    height = box.bottom - box.top
    if abs(dy) >= height:
        raise ValueError(f"dy must be less than the {height} rows that scroll, not {dy}")
    numbers = {**_numbers(controller, way, box, paged=dx != 0), "speed": speed}
    command = chip.command(way, dx < 0, columns=abs(dx), rows=-dy % height, **numbers)
    top = controller.row_offset + box.top
    area = (chip.command(chip.area, top=top, height=height),) if dy else ()
    return *area, command, chip.start


def scroll_once(controller: Controller, dx: int, dy: int, box: Box) -> tuple[bytes, ...]:
    """Return the command that moves a box of the glass by one column."""
    chip = _scroll(controller, dx, dy)
    if dy:
        raise ValueError(f"dy must be 0 where once is True, not {dy}: a single step is one across")
    if not chip.once:
        raise lacking(controller, "scroll by a single column", lambda other: other.scroll and other.scroll.once)
    return (chip.command(chip.once, dx < 0, **_numbers(controller, chip.once, box)),)


def beside(controller: Controller) -> Iterator[tuple[bytes, int]]:
    """Yield where the RAM's columns beside the glass are that a scroll brings past, and how many bytes from there.

    That is a command for the page pointer. There are none on chips that can leave these columns out.
    """
    chip, pointer = controller.scroll, controller.pointer
    if chip is None or "{left}" in chip.across or pointer is None:
        return
    right = controller.column_offset + controller.width
    for page in range(-(-controller.height // 8)):
        for left, count in ((0, controller.column_offset), (right, controller.ram_width - right)):
            if count:
                yield pointer.mode + bytes((pointer.row + page, left & 0x0F, 0x10 + (left >> 4))), count


def _scroll(controller: Controller, dx: int, dy: int) -> Scroll:
    """Check what holds for every scroll; return how the chip does it."""
    if controller.scroll is None:
        raise lacking(controller, "scroll by itself", lambda other: other.scroll)
    if abs(dx) > 1:
        raise ValueError(f"a step across the glass must be of one column, to the left or to the right, not of {dx}")
    if not (dx or dy):
        raise ValueError("dx and dy must not both be 0")
    return controller.scroll


def _numbers(controller: Controller, way: str, box: Box, *, paged: bool = True) -> dict[str, int]:
    """The pages or rows, and the columns, of a box, as the chip counts them."""
    wide, high = controller.cell
    left, right = controller.column_offset + box.left, controller.column_offset + box.right
    top, bottom = controller.row_offset + box.top, controller.row_offset + box.bottom
    if "{left}" not in way and box.right - box.left != controller.width:
        raise lacking(
            controller,
            "scroll some columns and keep others",
            lambda other: other.scroll and "{left}" in other.scroll.across,
        )
    if paged and (top % high or (bottom % high and box.bottom != controller.height)):
        raise ValueError(
            f"rows across the glass that scroll must be whole pages of {high}, not {box.top} to {box.bottom}"
        )
    if left % wide or right % wide:
        raise ValueError(f"columns that scroll must be multiples of {wide}, not {box.left} to {box.right}")
    return {"first": top // high, "last": (bottom - 1) // high, "left": left // wide, "right": right // wide - 1}
