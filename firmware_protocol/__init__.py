"""The serial link between a host and the firmware that drives a panel; `PROTOCOL.md` is its contract.

`HostLink` is the host's end, `Device` a reference for the other end. Nothing here knows the package that draws.
"""

from __future__ import annotations

from firmware_protocol.device import Device, SMBusWriter
from firmware_protocol.errors import (
    DeviceResetError,
    LinkError,
    LinkLostError,
    LinkTimeoutError,
    NoDeviceError,
    PanelFaultError,
    VersionError,
)
from firmware_protocol.line import LinkStats
from firmware_protocol.link import HostLink
from firmware_protocol.messages import Fault, Feature, HelloReply, Status

__all__ = [
    "Device",
    "DeviceResetError",
    "Fault",
    "Feature",
    "HelloReply",
    "HostLink",
    "LinkError",
    "LinkLostError",
    "LinkStats",
    "LinkTimeoutError",
    "NoDeviceError",
    "PanelFaultError",
    "SMBusWriter",
    "Status",
    "VersionError",
]
