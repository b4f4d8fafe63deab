"""Which segments of a digit show a character."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

DOT: Final = 0x80

_SHAPES: Final = """
    0 abcdef  1 bc  2 abdeg  3 abcdg  4 bcfg  5 acdfg  6 acdefg  7 abc  8 abcdefg  9 abcdfg
    A abcefg  B abcdefg  C adef  D abcdef  E adefg  F aefg  G acdef  H bcefg  I bc  J bcd  K acefg  L def  M ace
    N abcef  O abcdef  P abefg  Q abcfg  R aef  S acdfg  T defg  U bcdef  V bcdef  W bdf  X bcefg  Y bcdfg  Z abdeg
    a abcdeg  b cdefg  c deg  d bcdeg  e abdefg  f aefg  g abcdfg  h cefg  i c  j cd  k acefg  l ef  m ce
    n ceg  o cdeg  p abefg  q abcfg  r eg  s acdfg  t defg  u cde  v cde  w ce  x bcefg  y bcdfg  z abdeg
    ! bp  " bf  # bcdefg  $ acdfg  % begp  ' f  ( adef  ) abcd  * adg  + efg  , p  - g  . p  / beg
    : ad  ; acd  < deg  = dg  > cdg  ? abegp  @ abdefg  [ afg  \\ cfg  ] abg  ^ abf  _ d  ` b  { bcg  | ef  } efg
    ~ a  ° abfg
"""
"""Segments from a, the upper one, clockwise to f, g in the middle and p, the point, as luma's scripts know them."""


def _table() -> dict[str, int]:
    words = _SHAPES.split()
    bits = {segment: 0x40 >> place for place, segment in enumerate("abcdefg")} | {"p": DOT}
    shapes = zip(words[::2], words[1::2], strict=True)
    return {" ": 0} | {character: sum(bits[each] for each in segments) for character, segments in shapes}


DIGITS: Final = _table()


def regular(text: str, notfound: str | None = "_") -> Iterator[int]:
    """Yield a byte a character; one that cannot be shown is `notfound`, or left out where that is None."""
    for character in text:
        shown = character if character in DIGITS else notfound
        if shown is not None:
            yield DIGITS[shown]


def dot_muncher(text: str, notfound: str | None = "_") -> Iterator[int]:
    """Yield a byte a digit: a point lights that of the digit before it."""
    digits: list[int] = []
    pointed = True
    for segments in regular(text, notfound):
        if segments == DOT and not pointed:
            digits[-1] |= DOT
        else:
            digits.append(segments)
        pointed = segments == DOT
    yield from digits
