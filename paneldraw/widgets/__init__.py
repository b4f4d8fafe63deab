"""The usual parts of a panel's face: each keeps what it shows, and draws itself into a rectangle when asked.

>>> from paneldraw import Framebuffer
>>> from paneldraw.widgets import Battery, ProgressBar
>>> fb = Framebuffer(128, 64)
>>> Battery(0.8).draw(fb, 112, 0)
>>> ProgressBar(0.3, "{:.0%}").draw(fb, 4, 40, 120, 12)
>>> Battery(0.8).size
(15, 8)

A widget clears nothing: what is drawn lies over what is there, as with the framebuffer's own calls. Every one takes
``c=``, the level to draw with, and ``font=``.
"""

from __future__ import annotations

from .axis import ticks
from .charts import Bars, Chart, Sparkline
from .lists import Menu, ScrollBar, Tabs
from .messages import Log, Marquee, Toast
from .meters import Battery, Gauge, Number, ProgressBar, Signal
from .pages import Pages
from .qr import QRCode
from .widget import Widget

__all__ = [
    "Bars",
    "Battery",
    "Chart",
    "Gauge",
    "Log",
    "Marquee",
    "Menu",
    "Number",
    "Pages",
    "ProgressBar",
    "QRCode",
    "ScrollBar",
    "Signal",
    "Sparkline",
    "Tabs",
    "Toast",
    "Widget",
    "ticks",
]
