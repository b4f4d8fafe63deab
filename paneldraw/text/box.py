"""Text in a box: where its lines end, and what of it the box holds."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, NamedTuple

from paneldraw.errors import did_you_mean
from paneldraw.text.characters import is_invisible, is_mark
from paneldraw.text.font import Font, check_line_spacing, font_of, split_lines
from paneldraw.text.strike import NOTHING, Picture, overlaid

if TYPE_CHECKING:
    from typing import Literal, TypeAlias

    Align: TypeAlias = Literal["left", "center", "right"]
    Valign: TypeAlias = Literal["top", "middle", "bottom"]
    Wrap: TypeAlias = Literal["word", "letter"] | None

SOFT_HYPHEN = "\u00ad"
ZERO_WIDTH_SPACE = "\u200b"

_HYPHENS = "-\u2010\u2013\u2014"

# All of Unicode's spaces but those that hold words together.
_SPACES = {" ", "\t", "\u1680", "\u205f", "\u3000", *map(chr, range(0x2000, 0x200B))} - {"\u2007"}

_ALL_SPACES = "".join(_SPACES)

# What holds the letters on its sides together: no-break spaces and hyphens, and the word joiner.
_HOLDING = "\u00a0\u202f\u2060\u2011"

_JOINER = "\u200d"


class Line(NamedTuple):
    """A line of a wrapped text.

    Attributes
    ----------
    text : str
        What is drawn: without the spaces at its end, with the hyphen where a word is divided at a soft one.
    start, end : int
        The part of the whole text that it stands for, the spaces and the end of line behind it included.
    """

    text: str
    start: int
    end: int


@dataclass(frozen=True)
class BoxStyle:
    """How text is set in a box; see `Framebuffer.text_box`."""

    align: Align = "left"
    valign: Valign = "top"
    wrap: Wrap = "word"
    ellipsis: str = "…"
    line_spacing: int = 0

    def __post_init__(self) -> None:
        _check("align", self.align, ("left", "center", "right"))
        _check("valign", self.valign, ("top", "middle", "bottom"))
        _check("wrap", self.wrap, ("word", "letter", None))
        if not isinstance(self.ellipsis, str):
            raise TypeError(f"ellipsis must be a string, '' for none, not {type(self.ellipsis).__name__}")


def _check(name: str, value: object, choices: Sequence[object]) -> None:
    if not any(type(value) is type(known) and value == known for known in choices):
        words = [word for word in choices if isinstance(word, str)]
        hint = did_you_mean(value, words) if isinstance(value, str) else ""
        raise ValueError(f"{name} must be one of {', '.join(map(repr, choices))}, not {value!r}{hint}")


def wrap(text: str, width: int, font: Font | None = None, *, by: Wrap = "word") -> list[str]:
    """Return the lines of a text that is no wider than so many pixels.

    Parameters
    ----------
    text : str
        Ends of line in it stay.
    width : int
        Pixels, 1 or more. A letter that is wider stands on a line of its own.
    font : Font, optional
        Default: the built-in one.
    by : {"word", "letter", None}, default "word"
        Lines end behind spaces, hyphens and zero-width spaces, beside Chinese and Japanese letters, and at soft
        hyphens, which are seen there; a word that is wider than a line, behind any letter. No-break spaces and hyphens
        hold words together. Or behind any letter at all; or only where the text has an end of line.

    Raises
    ------
    TypeError
        If the text is not a string or the width is not a whole number.
    ValueError
        If the width is not positive, or there is no such way.

    Examples
    --------
    >>> from paneldraw.text import wrap
    >>> wrap("Wind north-west, rain", 60)
    ['Wind', 'north-', 'west, rain']
    """
    if not isinstance(width, int):
        raise TypeError(f"width must be a whole number, not {type(width).__name__}")
    if width < 1:
        raise ValueError(f"width must be 1 or more, not {width}")
    _check("by", by, ("word", "letter", None))
    split_lines(text)
    return [line.text for line in lines_of(text, width, font_of(font), by)]


def lines_of(text: str, width: int, font: Font, by: Wrap) -> Iterator[Line]:
    """Yield the lines of a text one by one; together they stand for all of it."""
    start = 0
    while start <= len(text):
        end, behind = _end_of_line(text, start)
        at = start
        while by is not None:
            letters = _some_letters(text, at, end, width, font)
            line = _first_line(text, at, letters, end, width, font, by)
            if line.end >= end:
                break
            yield line
            at = line.end
        yield Line(text[at:end] if by is None else _shown(text[at:end]), at, min(behind, len(text)))
        start = behind


def _end_of_line(text: str, start: int) -> tuple[int, int]:
    """Where the line of a text ends that starts there, and where the next one starts; beyond the text if none does."""
    end = text.find("\n", start)
    if end < 0:
        return len(text), len(text) + 1
    return end - (end > start and text[end - 1] == "\r"), end + 1


def _first_line(text: str, at: int, letters: int, end: int, width: int, font: Font, by: Wrap) -> Line:
    """The first line of text[at:end], of which text[at:letters] fits."""
    if letters >= end:
        return Line(_shown(text[at:end]), at, end)
    for place in range(letters, at if by == "word" else letters, -1):
        if _may_end(text, at, place, end):
            line = _line_until(text, at, place, end)
            if line.text and fits(line.text, width, font):
                return line
    line = _line_until(text, at, letters, end)
    return line if fits(line.text, width, font) else line._replace(text=_shown(text[at:letters]))


def _line_until(text: str, at: int, place: int, end: int) -> Line:
    """The line of text[at:place], and the spaces behind it."""
    behind = place
    while behind < end and text[behind] in _SPACES:
        behind += 1
    is_divided = text[place - 1] == SOFT_HYPHEN and behind < end
    return Line(text[at : place - 1] + "-" if is_divided else _shown(text[at:place]), at, behind)


def _shown(part: str) -> str:
    """A line without the spaces at its end."""
    return part.rstrip(_ALL_SPACES)


def _letters_that_fit(text: str, at: int, end: int, width: int, font: Font, more: str = "") -> int:
    """Where the longest start of text[at:end] ends that fits on a line, with `more` behind it; 0 if no letter does."""
    step = 16
    while at + step < end and fits(_shown(text[at : at + step]) + more, width, font):
        step *= 2
    low, high = at, min(at + step, end)
    while low < high:
        middle = (low + high + 1) // 2
        if fits(_shown(text[at:middle]) + more, width, font):
            low = middle
        else:
            high = middle - 1
    while low > at and not _is_between_letters(text, low):
        low -= 1
    return low if low > at else 0


def _some_letters(text: str, at: int, end: int, width: int, font: Font) -> int:
    """As `_letters_that_fit`, but at least one letter with its marks."""
    place = _letters_that_fit(text, at, end, width, font)
    if not place:
        place = min(at + 1, end)
        while place < end and not _is_between_letters(text, place):
            place += 1
    return place


def _is_between_letters(text: str, place: int) -> bool:
    """Whether a text may be cut there without parting a letter from its marks."""
    if place >= len(text):
        return True
    code = ord(text[place])
    held = is_mark(code) or (is_invisible(code) and text[place] not in (SOFT_HYPHEN, ZERO_WIDTH_SPACE))
    return not held and text[place - 1] != _JOINER


def _may_end(text: str, at: int, place: int, end: int) -> bool:
    """Whether a line of text[at:end] may end at a place, as lines of words do."""
    if place >= end or not _is_between_letters(text, place):
        return False
    before, behind = text[place - 1], text[place]
    if behind in _SPACES or before in _SPACES or before in (SOFT_HYPHEN, ZERO_WIDTH_SPACE):
        return True
    if before in _HYPHENS:
        # Not behind a sign: -5, --all.
        return place - 2 >= at and text[place - 2].isalnum() and behind.isalpha()
    return (_is_wide(before) or _is_wide(behind)) and not (_opens(before) or _closes(behind))


def _is_wide(char: str) -> bool:
    return char > "\u1100" and unicodedata.east_asian_width(char) in "WF"


def _opens(char: str) -> bool:
    return unicodedata.category(char) in ("Ps", "Pi") or char in _HOLDING


def _closes(char: str) -> bool:
    return unicodedata.category(char) in ("Pe", "Pf", "Po", "Lm") or char in _HOLDING


def fits(part: str, width: int, font: Font) -> bool:
    """Whether a part of a text is no wider than so many pixels, not counting the spaces at its end."""
    line = split_lines(_shown(part))[0]
    if font._glyphs is not None:
        # Seldom has the picture itself to tell, at ten times the cost.
        left, _, right, _ = font._glyphs.bounds(line)
        advance = font._glyphs.measure(line)
        if advance * font._factor > width:
            return False
        if (max(right, advance) - min(0, left)) * font._factor <= width:
            return True
    left, right = _reach(font._face.line(line))
    return right - left <= width


def _reach(picture: Picture) -> tuple[int, int]:
    """From which column to which, from its pen, a line takes room: its advance and what is lit beyond it."""
    return min(0, picture.left), max(math.ceil(picture.advance), picture.left + picture.ink.shape[1])


def chosen(text: str, width: int, height: int, font: Font, style: BoxStyle) -> tuple[list[str], str]:
    """Return the lines of a text that a box of so many pixels holds, and the rest of the text."""
    room = max(height + style.line_spacing, 0) // (font.height + style.line_spacing)
    lines = list(islice(lines_of(text, width, font, style.wrap), room))
    if not lines:
        return [], text if text.strip() else ""
    *lines, last = lines
    goes_on = bool(text[last.end :].strip())
    if style.wrap is None:
        lines = [_cut(text, line, width, font, style, False) for line in lines]
    if style.wrap is None or goes_on:
        last = _cut(text, last, width, font, style, goes_on)
    rest = text[last.end :]
    return [line.text for line in (*lines, last)], rest if rest.strip() else ""


def _cut(text: str, line: Line, width: int, font: Font, style: BoxStyle, goes_on: bool) -> Line:
    """The line with the ellipsis at its end, if it is too wide or the text goes on behind it."""
    end, behind = _end_of_line(text, line.start)
    if not goes_on and _some_letters(text, line.start, end, width, font) >= end:
        return line
    ellipsis = style.ellipsis
    if ellipsis == "…" and not font._face.has(ord(ellipsis)):
        ellipsis = "..."
    place = _letters_that_fit(text, line.start, end, width, font, ellipsis)
    if not place and (line.start < end or not fits(ellipsis, width, font)):
        # A letter is worth more than that there were others.
        ellipsis, place = "", _some_letters(text, line.start, end, width, font)
    if not ellipsis and style.wrap is not None:
        return line
    shown = _shown(text[line.start : place or end]) + ellipsis
    if style.wrap is None or max(place, line.start) == end:
        return Line(shown, line.start, min(behind, len(text)))
    return Line(shown, line.start, _line_until(text, line.start, place, end).end)


def boxed(text: str, width: int, height: int, font: Font | None, style: BoxStyle) -> tuple[Picture, str]:
    """Return what a text covers in a box, from the box's top-left corner, and the rest that it does not hold."""
    font = font_of(font)
    split_lines(text)
    check_line_spacing(style.line_spacing, font)
    if width < 1:
        return NOTHING, text
    lines, rest = chosen(text, width, height, font, style)
    step = font.height + style.line_spacing
    free = height - step * len(lines) + style.line_spacing
    top = {"top": 0, "middle": free // 2, "bottom": free}[style.valign]
    placed = []
    for number, line in enumerate(lines):
        picture = font._face.line(split_lines(line)[0])
        left, right = _reach(picture)
        free = max(width - (right - left), 0)
        x = {"left": 0, "center": free // 2, "right": free}[style.align] - left
        placed.append(picture._replace(left=x + picture.left, top=top + number * step + picture.top))
    return within(overlaid(placed, 0), (height, width)), rest


def within(picture: Picture, shape: tuple[int, int]) -> Picture:
    """The part of a picture that lies in a box of so many rows and columns."""
    height, width = shape
    left, top = max(-picture.left, 0), max(-picture.top, 0)
    ink = picture.ink[top : max(height - picture.top, 0), left : max(width - picture.left, 0)]
    return picture._replace(ink=ink, left=picture.left + left, top=picture.top + top)
