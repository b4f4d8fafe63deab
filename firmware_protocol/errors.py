"""What can go wrong between the host and the device. Wrong arguments are ``ValueError`` and ``TypeError``."""

from __future__ import annotations

from firmware_protocol.messages import Fault


class LinkError(Exception):
    """Root of the link's errors; each message says what to do."""


class LinkLostError(LinkError):
    """The port is gone or will not open."""


class NoDeviceError(LinkError):
    """The port works and nothing on it speaks the protocol."""


class LinkTimeoutError(LinkError):
    """The device spoke and has fallen silent."""


class VersionError(LinkError):
    """Host and device have no version of the protocol in common."""


class DeviceResetError(LinkError):
    """The device has started anew; what was under way is lost and the panel may need its set-up again."""


class PanelFaultError(LinkError):
    """The device works and could not write to its panel.

    Attributes
    ----------
    fault : Fault
        What the device said.
    """

    def __init__(self, fault: Fault, message: str) -> None:
        super().__init__(message)
        self.fault = fault
