"""Devices that are not there: windows onto larger pictures, live spots in them, terminals, savepoints, digits."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterable, Iterator, MutableSequence
from textwrap import TextWrapper
from typing import Any, Final, overload

from PIL import Image, ImageDraw, ImageFont

from paneldraw.compat.luma.core.mixin import capabilities
from paneldraw.compat.luma.core.render import canvas

__all__ = ["calc_bounds", "history", "hotspot", "range_overlap", "sevensegment", "snapshot", "terminal", "viewport"]

Point = tuple[int, int]


def calc_bounds(xy: Point, entity: Any) -> tuple[int, int, int, int]:
    """Return left, top, right and bottom of something of a width and height at a place.

    Examples
    --------
    >>> calc_bounds((10, 4), hotspot(20, 8))
    (10, 4, 30, 12)
    """
    return xy[0], xy[1], xy[0] + entity.width, xy[1] + entity.height


def range_overlap(a_min: int, a_max: int, b_min: int, b_max: int) -> bool:
    """Whether two ranges, each without its end, have something in common.

    Examples
    --------
    >>> range_overlap(0, 8, 7, 10), range_overlap(0, 8, 8, 10)
    (True, False)
    """
    return a_min < b_max and b_min < a_max


class viewport(capabilities):
    """A window, of a device's size, onto a larger picture.

    Parameters
    ----------
    device : device
    width, height : int
        Pixels of the picture.
    mode : str, optional
        Pillow's mode of the picture. Default: the device's.
    dither : bool, optional
        Let error diffusion make what the window shows the device's mode. Default: False.

    Examples
    --------
    >>> from paneldraw.compat.luma.core.device import dummy
    >>> device = dummy(64, 32, mode="1")
    >>> strip = viewport(device, 200, 32)
    >>> with canvas(strip) as draw:
    ...     draw.rectangle((100, 8, 109, 15), fill="white")
    >>> strip.set_position((90, 0))
    >>> device.image.getbbox()
    (10, 8, 20, 16)
    """

    def __init__(
        self, device: capabilities, width: int, height: int, mode: str | None = None, dither: bool = False
    ) -> None:
        self.capabilities(width, height, 0, mode or device.mode)
        if hasattr(device, "segment_mapper"):
            self.segment_mapper = device.segment_mapper
        self._device, self._dither = device, dither
        self._picture = Image.new(self.mode, self.size)
        self._position: Point = (0, 0)
        self._hotspots: list[tuple[hotspot, Point]] = []
        self._dirty = False

    def display(self, image: Image.Image) -> None:
        """Show the part of an image of this size that is in the window."""
        self._check(image)
        self._picture.paste(image)
        self.refresh(force=True)

    def set_position(self, xy: Point) -> None:
        """Move the window's upper left corner to a place, and show what is there."""
        self._position = xy
        self.refresh(force=True)

    def add_hotspot(self, hotspot: hotspot, xy: Point) -> None:
        """Put a hotspot at a place, where it must be inside the picture."""
        left, top, right, bottom = calc_bounds(xy, hotspot)
        if left < 0 or top < 0 or right > self.width or bottom > self.height:
            raise ValueError(f"hotspot must be inside {self.width}x{self.height}, not at {xy} to {(right, bottom)}")
        self._hotspots.append((hotspot, xy))

    def remove_hotspot(self, hotspot: hotspot, xy: Point) -> None:
        """Take a hotspot away; its place is black with the next `refresh`."""
        self._hotspots.remove((hotspot, xy))
        self._picture.paste(Image.new(self.mode, hotspot.size), xy)
        self._dirty = True

    def is_overlapping_viewport(self, hotspot: hotspot, xy: Point) -> bool:
        """Whether some of a hotspot is in the window."""
        left, top, right, bottom = calc_bounds(xy, hotspot)
        x1, y1, x2, y2 = calc_bounds(self._position, self._device)
        return range_overlap(left, right, x1, x2) and range_overlap(top, bottom, y1, y2)

    def refresh(self, force: bool = False) -> None:
        """Let the hotspots in the window draw that want to; show the window if one did, or by `force`."""
        for spot, xy in self._hotspots:
            if spot.should_redraw() and self.is_overlapping_viewport(spot, xy):
                spot.paste_into(self._picture, xy)
                self._dirty = True
        if force or self._dirty:
            seen = self._picture.crop(self._window())
            self._device.display(seen.convert(self._device.mode) if self._dither else seen)
            self._dirty = False

    def _window(self) -> tuple[int, int, int, int]:
        window = calc_bounds(self._position, self._device)
        if window[0] < 0 or window[1] < 0 or window[2] > self.width or window[3] > self.height:
            end = f"{self.width - self._device.width}, {self.height - self._device.height}"
            raise ValueError(f"position must be (0, 0) to ({end}), not {self._position}")
        return window


class hotspot(capabilities):
    """A part of a viewport that draws itself whenever it is seen.

    Parameters
    ----------
    width, height : int
    draw_fn : callable, optional
        Called with an ImageDraw, the width and the height. Default: a subclass has `update` instead.

    Examples
    --------
    >>> from paneldraw.compat.luma.core.device import dummy
    >>> device = dummy(64, 32, mode="1")
    >>> view = viewport(device, 200, 32)
    >>> spot = hotspot(10, 10, lambda draw, width, height: draw.rectangle((0, 0, 4, 4), fill="white"))
    >>> view.add_hotspot(spot, (20, 8))
    >>> view.refresh()
    >>> device.image.getbbox()
    (20, 8, 25, 13)
    """

    def __init__(self, width: int, height: int, draw_fn: Callable[[Any, int, int], object] | None = None) -> None:
        self.capabilities(width, height, 0)
        self._fn = draw_fn

    def paste_into(self, image: Image.Image, xy: Point) -> None:
        """Draw it anew and put it into an image."""
        own = Image.new(image.mode, self.size)
        self.update(ImageDraw.Draw(own))
        image.paste(own, xy)

    def should_redraw(self) -> bool:
        """Whether there may be something new to draw."""
        return True

    def update(self, draw: ImageDraw.ImageDraw) -> None:
        """Draw it."""
        if self._fn is not None:
            self._fn(draw, self.width, self.height)


class snapshot(hotspot):
    """A hotspot that draws itself only every `interval` seconds.

    Examples
    --------
    >>> spot = snapshot(40, 10, lambda draw, width, height: draw.text((0, 0), "now"), interval=60.0)
    >>> spot.paste_into(Image.new("1", (64, 32)), (0, 0))
    >>> spot.should_redraw()
    False
    """

    def __init__(
        self,
        width: int,
        height: int,
        draw_fn: Callable[[Any, int, int], object] | None = None,
        interval: float = 1.0,
    ) -> None:
        if not interval > 0:
            raise ValueError(f"interval must be seconds above 0, not {interval!r}")
        super().__init__(width, height, draw_fn)
        self.interval = interval
        self.last_updated = -interval

    def should_redraw(self) -> bool:
        """Whether the interval is over."""
        return time.perf_counter() - self.last_updated > self.interval

    def paste_into(self, image: Image.Image, xy: Point) -> None:
        """Draw it anew and put it into an image."""
        super().paste_into(image, xy)
        self.last_updated = time.perf_counter()


_COLORS: Final = ("black", "red", "green", "yellow", "blue", "magenta", "cyan", "white")
_SEQUENCE: Final = re.compile(r"\033\[(\d+(?:;\d+)*)m|(.)", re.DOTALL)


class terminal:
    """A screen of text that scrolls, over a device.

    Parameters
    ----------
    device : device or virtual device
    font : PIL.ImageFont, optional
        Default: Pillow's own.
    color, bgcolor : str or tuple, optional
        Of letters and ground. Default: ``"white"`` and ``"black"``.
    tabstop : int, optional
        Characters between tab stops. Default: 4.
    line_height : int, optional
        Pixels from line to line. Default: the height of the font's tallest character.
    animate : bool, optional
        Show each character as it comes, as a teletype does. Default: True.
    word_wrap : bool, optional
        Break lines of `println` between words. Default: False.

    Examples
    --------
    >>> from paneldraw.compat.luma.core.device import dummy
    >>> term = terminal(dummy(mode="1"), animate=False)
    >>> term.println("Hello")
    >>> term.puts("\\033[7mreversed\\033[0m")
    """

    def __init__(
        self,
        device: capabilities,
        font: Any = None,
        color: Any = "white",
        bgcolor: Any = "black",
        tabstop: int = 4,
        line_height: int | None = None,
        animate: bool = True,
        word_wrap: bool = False,
    ) -> None:
        self._device = device
        self.font = font or ImageFont.load_default()
        self.default_fgcolor, self.default_bgcolor = color, bgcolor
        self.tabstop, self.animate, self.word_wrap = tabstop, animate, word_wrap
        boxes = [self.font.getbbox(chr(code)) for code in range(32, 128)]
        self._cw = max(right for _, _, right, _ in boxes)
        self._ch = line_height or max(bottom for _, _, _, bottom in boxes)
        self.width, self.height = self.size = int(device.width // self._cw), int(device.height // self._ch)
        self.reset()
        self._picture = Image.new(device.mode, device.size, self._bgcolor)
        self._draw = ImageDraw.Draw(self._picture)
        self.clear()

    def clear(self) -> None:
        """Clear the screen, and start at its top."""
        self._x: float = 0
        self._y: float = 0
        self._draw.rectangle(self._device.bounding_box, fill=self.default_bgcolor)
        self.flush()

    def println(self, text: str = "") -> None:
        """Print text and end the line."""
        if not self.word_wrap:
            self.puts(text)
            self.newline()
            return
        wrapper = TextWrapper(self.width, expand_tabs=False, replace_whitespace=False, drop_whitespace=False)
        steps = self._steps(text)
        for line in wrapper.wrap(_SEQUENCE.sub(r"\2", text)):
            left = len(line)
            while left:
                name, *arguments = next(steps)
                getattr(self, name)(*arguments)
                left -= name == "putch"
            self.newline()

    def puts(self, text: str) -> None:
        r"""Print text with ``\r``, ``\n``, ``\b``, ``\t`` and ANSI's sequences for colors."""
        for name, *arguments in self._steps(text):
            getattr(self, name)(*arguments)

    def _steps(self, text: str) -> Iterator[list[Any]]:
        """Yield a method's name and arguments for each character and each code of a sequence."""
        for codes, character in _SEQUENCE.findall(text):
            if character:
                yield ["putch", character]
            for code in map(int, filter(None, codes.split(";"))):
                if code == 0:
                    yield ["reset"]
                elif code == 7:
                    yield ["reverse_colors"]
                elif code // 10 in (3, 4) and code % 10 < len(_COLORS):
                    yield ["foreground_color" if code < 40 else "background_color", _COLORS[code % 10]]

    def putch(self, char: str) -> None:
        r"""Print a character, or do what ``\r``, ``\n``, ``\b`` or ``\t`` says."""
        control = {"\r": self.carriage_return, "\n": self.newline, "\b": self.backspace, "\t": self.tab}.get(char)
        if control is not None:
            control()
            return
        width = self.font.getbbox(char)[2]
        if self._x + width >= self._device.width:
            self.newline()
        self.erase()
        self._draw.text((self._x, self._y), char, font=self.font, fill=self._fgcolor)
        self._x += width
        if self.animate:
            self.flush()

    def carriage_return(self) -> None:
        """Go to the start of the line."""
        self._x = 0

    def tab(self) -> None:
        """Print spaces up to the next tab stop."""
        for _ in range(self.tabstop - int(self._x // self._cw) % self.tabstop):
            self.putch(" ")

    def newline(self) -> None:
        """Go to the start of the next line; at the bottom everything scrolls up by one."""
        self.carriage_return()
        width, height = self._device.size
        if self._y + 2 * self._ch >= height:
            self._picture.paste(self._picture.crop((0, self._ch, width, height)), (0, 0))
            self._draw.rectangle((0, height - self._ch, width, height), fill=self.default_bgcolor)
        else:
            self._y += self._ch
        self.flush()
        if self.animate:
            time.sleep(0.2)

    def backspace(self) -> None:
        """Clear the current place and go one to the left."""
        if self._x + self._cw >= 0:
            self.erase()
            self._x -= self._cw
        self.flush()

    def erase(self) -> None:
        """Clear the current place."""
        self._draw.rectangle((self._x, self._y, self._x + self._cw, self._y + self._ch), fill=self._bgcolor)

    def flush(self) -> None:
        """Show the screen on the device."""
        self._device.display(self._picture)

    def foreground_color(self, value: Any) -> None:
        """Set the color of letters: Pillow's name of it, or red, green and blue."""
        self._fgcolor = value

    def background_color(self, value: Any) -> None:
        """Set the color behind letters."""
        self._bgcolor = value

    def reset(self) -> None:
        """Go back to the first colors."""
        self._fgcolor, self._bgcolor = self.default_fgcolor, self.default_bgcolor

    def reverse_colors(self) -> None:
        """Swap the colors of letters and ground."""
        self._fgcolor, self._bgcolor = self._bgcolor, self._fgcolor


class history(capabilities):
    """A device that can go back to what it showed before.

    Examples
    --------
    >>> from paneldraw.compat.luma.core.device import dummy
    >>> screen = history(dummy(mode="1"))
    >>> screen.clear()
    >>> screen.savepoint()
    >>> screen.display(Image.new("1", (128, 64), 1))
    >>> screen.restore()
    >>> len(screen)
    0
    """

    def __init__(self, device: capabilities) -> None:
        self.capabilities(device.width, device.height, 0, device.mode)
        if hasattr(device, "segment_mapper"):
            self.segment_mapper = device.segment_mapper
        self._device = device
        self._savepoints: list[Image.Image] = []
        self._last: Image.Image | None = None

    def display(self, image: Image.Image) -> None:
        """Show an image."""
        self._last = image.copy()
        self._device.display(image)

    def savepoint(self) -> None:
        """Remember the last image."""
        if self._last is not None:
            self._savepoints.append(self._last)
            self._last = None

    def restore(self, drop: int = 0) -> None:
        """Show the image that was remembered last, or the one `drop` before it, and forget it and the later ones."""
        if not 0 <= drop < len(self._savepoints):
            raise IndexError(f"drop must be 0 to {len(self._savepoints) - 1}, not {drop}: so many savepoints there are")
        image = self._savepoints[-1 - drop]
        del self._savepoints[-1 - drop :]
        self.display(image)

    def __len__(self) -> int:
        return len(self._savepoints)


class sevensegment:
    """Digits of seven segments, which show the text that `text` is set to.

    Parameters
    ----------
    device : max7219
    undefined : str, optional
        What is shown for a character that seven segments cannot. Default: ``"_"``.
    segment_mapper : callable, optional
        Makes bytes of a text. Default: the device's.

    Examples
    --------
    >>> from paneldraw.compat.luma.core.device import dummy
    >>> from paneldraw.compat.luma.led_matrix.segment_mapper import dot_muncher
    >>> digits = sevensegment(dummy(8, 8, mode="1"), segment_mapper=dot_muncher)
    >>> digits.text = "21.5"
    >>> digits.text[0] = "3"
    >>> digits.text
    31.5
    """

    def __init__(
        self, device: Any, undefined: str = "_", segment_mapper: Callable[..., Iterable[int]] | None = None
    ) -> None:
        self.device, self.undefined = device, undefined
        self.segment_mapper = segment_mapper or device.segment_mapper
        self._digits = device.width * device.height // 8
        self.text = ""

    @property
    def text(self) -> Any:
        """What is shown; a change of one of its characters or slices is shown at once."""
        return self._text

    @text.setter
    def text(self, value: Iterable[str]) -> None:
        self._text = _Characters(value, self._show)
        self._show(self._text)

    def _show(self, text: _Characters) -> None:
        digits = bytes(self.segment_mapper(text, notfound=self.undefined))
        if len(digits) > self._digits:
            raise OverflowError(f"text must fit {self._digits} digits, not {str(text)!r}")
        with canvas(self.device) as draw:
            for x, segments in enumerate(reversed(digits.ljust(self._digits, b"\0"))):
                draw.point([(x, y) for y in range(8) if segments >> y & 1], fill="white")


class _Characters(MutableSequence[str]):
    """A text that can be changed in place, and says so."""

    def __init__(self, text: Iterable[str], changed: Callable[[_Characters], object]) -> None:
        self._text, self._changed = "".join(text), changed

    def __str__(self) -> str:
        return self._text

    __repr__ = __str__

    def __eq__(self, other: object) -> bool:
        return self._text == str(other)

    __hash__ = None  # type: ignore[assignment]

    def __len__(self) -> int:
        return len(self._text)

    @overload
    def __getitem__(self, index: int) -> str: ...
    @overload
    def __getitem__(self, index: slice) -> MutableSequence[str]: ...
    def __getitem__(self, index: Any) -> Any:
        return self._text[index]

    def __setitem__(self, index: Any, value: Any) -> None:
        self._edit(index, value)

    def __delitem__(self, index: Any) -> None:
        self._edit(index, "")

    def insert(self, index: int, value: str) -> None:
        """Put characters before one."""
        self._edit(slice(index, index), value)

    def _edit(self, index: Any, value: str) -> None:
        characters: list[str] = list(self._text)
        if isinstance(index, slice):
            characters[index] = value
        else:
            characters[index] = value
        self._text = "".join(characters)
        self._changed(self)
