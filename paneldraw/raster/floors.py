"""The floor of a number; compiled modules have it from floors.pxd, without a call."""

from math import floor as floored  # noqa: F401
