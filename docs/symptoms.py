"""Pictures of trouble.md and which_panel.md: the test card of `paneldraw check` on modules that are driven wrongly."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from PIL import Image

from paneldraw import Panel, simulator, urls
from paneldraw.cli.check import card
from paneldraw.transports import I2CTransport

SCALE = 3
_DIM = 0.3
"""How bright a panel may be that lacks its reference current; the simulator knows of none."""


class Mirrored(simulator.SSD1306):
    """A module whose glass is bonded the other way round."""

    upright = (False, True)


class Hanging(simulator.SSD1306):
    """A module that was mounted upside down."""

    upright = (False, False)


@dataclass(frozen=True)
class Symptom:
    """A module, what is believed of it, and what mends that.

    Attributes
    ----------
    module : callable
        Makes the simulated chip with its glass.
    believed : str
        Parameters of the URL with which it looks wrong.
    mend : str
        What to add to them, or to say instead. Default: nothing, it looks right.
    """

    module: Callable[[], Any]
    believed: str = "chip=ssd1306"
    mend: str = ""


SYMPTOMS: Mapping[str, Symptom] = {
    "right": Symptom(simulator.SSD1306),
    "noise": Symptom(simulator.SH1106, mend="chip=sh1106"),
    "shifted": Symptom(simulator.SH1106, believed="updates=plain", mend="chip=sh1106"),
    "shifted_back": Symptom(partial(simulator.SH1106, column_offset=0), believed="chip=sh1106", mend="column_offset=0"),
    "other_lines": Symptom(partial(simulator.SSD1306, 128, 32), mend="size=128x32"),
    "half_lines": Symptom(simulator.SSD1306, believed="size=128x32", mend="size=128x64"),
    "com_pins": Symptom(partial(simulator.SSD1306, com_pins=0x02), mend="com_pins=0x02"),
    "first_com": Symptom(partial(simulator.SSD1306, 64, 32, first_com=16), believed="size=64x32", mend="first_com=16"),
    "mirrored": Symptom(Mirrored, mend="mirror_x=1"),
    "upside_down": Symptom(Hanging, mend="rotate=180"),
    "dim": Symptom(
        partial(simulator.SSD1315, 72, 40),
        believed="chip=ssd1315&size=72x40&internal_reference=0",
        mend="internal_reference=1",
    ),
    "dark": Symptom(simulator.SSD1306, believed="charge_pump=0", mend="charge_pump=1"),
}


def shown(symptom: Symptom, *, mended: bool = False) -> Any:
    """What the module's glass shows of the test card, as levels from 0 to 1."""
    said = "&".join([symptom.believed, symptom.mend] if mended else [symptom.believed])
    url = urls.parse("i2c://1/0x3c?" + _last_of_each(said))
    assert isinstance(url, urls.PanelURL)
    chip = symptom.module()
    with Panel(url.controller, I2CTransport(simulator.I2CBus({0x3C: chip})), **url.panel) as panel:
        fb = panel.framebuffer()
        card(fb)
        panel.show(fb)
        unfed = "reference" in vars(chip.registers) and not chip.registers.reference
        return chip.pixels * (_DIM if unfed else 1.0)


def _last_of_each(query: str) -> str:
    """Parameters of which what is said last holds."""
    return "&".join(
        f"{name}={value}" for name, value in dict(pair.split("=") for pair in query.split("&") if pair).items()
    )


def draw(symptom: Symptom) -> Image.Image:
    """A module's glass as it looks."""
    levels = np.rint(255 * shown(symptom)).astype(np.uint8)
    return simulator.image(levels, scale=SCALE, max_level=255)


def pictures() -> dict[str, Callable[[], Image.Image]]:
    """What draws each of them, by its file name."""
    return {f"panels/{name}.png": partial(draw, symptom) for name, symptom in SYMPTOMS.items()}
