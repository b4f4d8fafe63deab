"""Fonts and text layout: which pixels a text covers, never how they are painted."""

from __future__ import annotations

from paneldraw.text.box import BoxStyle as BoxStyle
from paneldraw.text.box import boxed as boxed
from paneldraw.text.box import within as within
from paneldraw.text.box import wrap
from paneldraw.text.characters import composed as composed
from paneldraw.text.console import Console
from paneldraw.text.font import TAB as TAB
from paneldraw.text.font import Font
from paneldraw.text.font import font_of as font_of
from paneldraw.text.font import font_on as font_on
from paneldraw.text.font import split_lines as split_lines
from paneldraw.text.layout import offset as offset
from paneldraw.text.layout import render
from paneldraw.text.marquee import Marquee

__all__ = ["Console", "Font", "Marquee", "render", "wrap"]
