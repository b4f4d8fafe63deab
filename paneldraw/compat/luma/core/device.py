"""Panels as luma's scripts hold them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, ClassVar

import numpy as np
from PIL import Image

from paneldraw.compat.luma.core.error import DeviceDisplayModeError
from paneldraw.compat.luma.core.framebuffer import diff_to_previous, full_frame
from paneldraw.compat.luma.core.interface.serial import Interface, carrier, i2c
from paneldraw.compat.luma.core.mixin import capabilities
from paneldraw.controllers import Chain, Chip
from paneldraw.panel import Panel

_GRAY = np.array([306, 601, 117], np.uint32)
"""Weights of red, green and blue, of 1024 in all, by which luma.oled makes colors gray before it cuts off the rest."""


class device(capabilities):
    """A panel that displays Pillow images.

    Use the class of a chip, such as `paneldraw.compat.luma.oled.device.ssd1306`. The panel is dark until the first
    picture, and black and off when the script ends, unless `persist` is set.

    Parameters
    ----------
    serial_interface : i2c or spi, optional
        What the panel is on, or any object with luma's ``command(*bytes)`` and ``data(sequence)``. Default: ``i2c()``.
    width, height : int, optional
        Pixels of the glass before it is turned. Default: what modules with this chip mostly have.
    rotate : int, optional
        Quarter turns clockwise. Default: 0.
    mode : str, optional
        Pillow's mode of what is displayed; chips with grays have ``"RGB"`` (their default) and ``"1"``.
    framebuffer : full_frame, optional
        Send every picture as a whole. Default: what differs.
    **wiring : int
        What `paneldraw.controllers` takes of this chip's modules, such as ``column_offset=2``.

    Attributes
    ----------
    panel : paneldraw.Panel
        What does the work; all that it can is here for scripts that move on.

    Raises
    ------
    DeviceDisplayModeError
        A size, rotation or mode that the chip has not.
    Error
        The panel cannot be reached; the message says what to do.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> from paneldraw.compat.luma.core.interface.serial import i2c
    >>> from paneldraw.compat.luma.core.render import canvas
    >>> from paneldraw.compat.luma.oled.device import ssd1306
    >>> chip = simulator.SSD1306(128, 64)
    >>> device = ssd1306(i2c(bus=simulator.I2CBus({0x3C: chip})))
    >>> with canvas(device) as draw:
    ...     draw.rectangle(device.bounding_box, outline="white")
    >>> int(chip.pixels.sum())
    380
    """

    chip: ClassVar[Chip | Chain]
    glass: ClassVar[tuple[int, int]]
    """Pixels where a script does not say."""
    modes: ClassVar[tuple[str, ...]] = ("1",)
    """Modes that can be displayed, the default first."""
    wiring: ClassVar[Mapping[str, Any]] = {}
    """Of what module luma means this chip to be."""
    contrast_shift: ClassVar[int] = 0
    """Bits that luma's levels of contrast are short of eight."""

    def __init__(
        self,
        serial_interface: Interface | None = None,
        width: int | None = None,
        height: int | None = None,
        rotate: int = 0,
        *,
        mode: str | None = None,
        framebuffer: diff_to_previous | full_frame | None = None,
        **wiring: Any,
    ) -> None:
        mode = self.modes[0] if mode is None else mode
        if mode not in self.modes:
            known = " or ".join(self.modes)
            raise DeviceDisplayModeError(f"mode of the {self.chip.name} must be {known}, not {mode!r}")
        size = width or self.glass[0], height or self.glass[1]
        try:
            record = self.chip(*size, **{**self.wiring, **wiring})
        except ValueError as error:
            raise DeviceDisplayModeError(f"Unsupported display mode: {error}") from error
        self.capabilities(*size, rotate, mode)
        updates = "least" if framebuffer is None else framebuffer.updates
        transport = carrier(i2c() if serial_interface is None else serial_interface, record)
        self.panel = Panel(record, transport, rotate=90 * rotate, updates=updates, on_close="off")

    @property
    def persist(self) -> bool:
        """Whether the picture stays when the script ends. Default: False."""
        return self._persist

    @persist.setter
    def persist(self, value: bool) -> None:
        self._persist = value
        if hasattr(self, "panel"):
            self.panel.on_close = "keep" if value else "off"

    def preprocess(self, image: Image.Image) -> Image.Image:
        """Return the image as it is: the panel turns it."""
        return image

    def display(self, image: Image.Image) -> None:
        """Show an image of this size and mode; what differs from the last one travels."""
        self._check(image)
        image = self.preprocess(image)
        if self.mode == "1":
            self.panel.show(image)
        else:
            shift = 18 - self.panel.depth
            self.panel.show((np.asarray(image) @ _GRAY >> shift).astype(np.uint8))

    def show(self) -> None:
        """Light the panel after `hide`."""
        self.panel.wake()

    def hide(self) -> None:
        """Turn the panel dark; it keeps its picture."""
        self.panel.sleep()

    def contrast(self, level: int) -> None:
        """Set the brightness of lit pixels, 0 to 255; LCDs and the SSD1325 are at their highest long before."""
        self.panel.contrast(min(level << self.contrast_shift, 255) if level <= 255 else level)

    def command(self, *cmd: int) -> None:
        """Send a command with its arguments, as the datasheet has them."""
        self.panel.command(bytes(cmd))

    def data(self, data: Iterable[int]) -> None:
        """Send bytes of data. The next picture goes out whole, as the panel's content is not known any more."""
        self.panel.transport.data(bytes(data))
        self.panel.invalidate()

    def cleanup(self) -> None:
        """Turn the panel black and off unless it is to `persist`, and close what it is on."""
        if not self.persist:
            self.panel.clear()
        self.panel.close()


class dummy(capabilities):
    """A device without a panel, which keeps the last image in `image`."""

    def __init__(
        self, width: int = 128, height: int = 64, rotate: int = 0, mode: str = "RGB", serial_interface: Any = None
    ) -> None:
        self.capabilities(width, height, rotate, mode)
        self.image: Image.Image | None = None

    def display(self, image: Image.Image) -> None:
        """Keep an image, turned as the glass would have it."""
        self._check(image)
        self.image = self.preprocess(image).copy()

    def show(self) -> None:
        """Do nothing."""

    def hide(self) -> None:
        """Do nothing."""

    def contrast(self, level: int) -> None:
        """Do nothing but check."""
        if not 0 <= level <= 255:
            raise ValueError(f"level must be 0 to 255, not {level}")

    def cleanup(self) -> None:
        """Do nothing."""
