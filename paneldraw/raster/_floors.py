"""The floor of a number; compiled modules have it from _floors.pxd, without a call."""

from math import floor as floored

__all__ = ["floored"]
