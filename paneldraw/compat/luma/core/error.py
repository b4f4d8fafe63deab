"""Errors under luma's names; they are paneldraw's own."""

from __future__ import annotations

from paneldraw.errors import PanelError, PanelNotFoundError, PanelPermissionError

Error = PanelError
DeviceNotFoundError = PanelNotFoundError
DevicePermissionError = PanelPermissionError


class DeviceAddressError(PanelError, ValueError):
    """An I2C address that is none."""


class DeviceDisplayModeError(PanelError, ValueError):
    """A size, rotation or color mode that the display has not."""


class UnsupportedPlatform(PanelError):
    """Something that only luma can do, or that this machine cannot."""
