"""QR codes, which phones read off a panel."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from paneldraw.widgets.widget import Widget

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from paneldraw import Framebuffer


@dataclass(frozen=True, slots=True, eq=False)
class QRCode(Widget):
    """A QR code as large as fits, by whole factors, dark on light as phones expect it.

    It needs the package segno: ``pip install "paneldraw[qr]"``. A code of 64 x 64 pixels holds some 50 letters of an
    address. Where even its smallest form does not fit, a frame with a question mark is drawn.

    Attributes
    ----------
    text : str
        Such as ``"https://example.org"``.
    error : {"L", "M", "Q", "H"}
        How much of it may be unreadable: 7, 15, 25 or 30 percent.
    border : int
        Light modules around it. The standard wants 4; phones read it with 1.

    Raises
    ------
    ImportError
        If segno is not installed, as soon as the code is drawn or asked for its size.
    ValueError
        If the text is too long for any QR code, or `error` is none of these.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import QRCode
    >>> fb = Framebuffer(64, 64)
    >>> QRCode("https://example.org").draw(fb)
    """

    text: str
    error: str = "L"
    border: int = 1

    @property
    def size(self) -> tuple[int, int]:
        side = len(_modules(self.text, self.error)) + 2 * max(self.border, 0)
        return side, side

    def _paint(self, fb: Framebuffer, c: int) -> None:
        modules = _modules(self.text, self.error)
        room = min(fb.width, fb.height)
        if len(modules) > room:
            fb.rect(0, 0, fb.width, fb.height, c)
            fb.text("?", (fb.width - 1) // 2, (fb.height - 1) // 2, c, font=self._font, anchor="mm")
            return
        border = min(max(self.border, 0), (room - len(modules)) // 2)
        light = np.pad(1 - modules, border, constant_values=1)
        factor = room // len(light)
        picture = light.repeat(factor, axis=0).repeat(factor, axis=1) * np.uint8(c)
        fb.blit(picture, (fb.width - len(picture)) // 2, (fb.height - len(picture)) // 2)


@functools.lru_cache(16)
def _modules(text: str, error: str) -> NDArray[np.uint8]:
    """The code's modules, 1 where it is dark."""
    try:
        import segno
    except ImportError:
        raise ImportError('QR codes need the package segno: pip install "paneldraw[qr]"') from None
    code = segno.make(text, error=error, micro=False)
    return np.array([list(row) for row in code.matrix], np.uint8)
