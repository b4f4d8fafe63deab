"""The floor of a number, and its whole part; compiled modules have them from floors.pxd, without a call."""

from math import floor as floored  # noqa: F401

cut_off = int
