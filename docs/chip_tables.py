"""The table of chips.md, made of `paneldraw.controllers.CHIPS`."""

from __future__ import annotations

from worked_examples import table

from paneldraw.controllers import BUSES, CHIPS
from paneldraw.controllers.features import by_itself


def chips() -> str:
    rows = []
    for name, chip in CHIPS.items():
        buses = ", ".join(BUSES[bus] for bus in chip.buses)
        sizes = ", ".join(f"{width}x{height}" for width, height in chip.sizes)
        rows.append((f"`{name}`", chip.about, buses, 2**chip.depth, sizes, ", ".join(by_itself(chip()))))
    return table("chip|what it is|on|levels|sizes|by itself", rows)
