"""What `paneldraw panels` says of the chips."""

from __future__ import annotations

from collections.abc import Iterator

from paneldraw.controllers import BUSES, CHIPS
from paneldraw.controllers.features import by_itself
from paneldraw.errors import did_you_mean

PARAMETERS = {
    "column_offset": "first RAM column of the glass; another one where the picture is shifted or has a noisy edge",
    "row_offset": "first RAM row of the glass",
    "first_com": "first COM line of the glass; a picture that begins in the middle needs another",
    "com_pins": "0x02, 0x12, 0x22 or 0x32; where lines are missing or doubled, another",
    "charge_pump": "0 where the module has a panel supply of its own",
    "internal_reference": "1 where the picture is right and dim",
    "bias": "LCD: 9 for 1/9, and so on; another one where dots that are off show",
    "resistor_ratio": "LCD: 0 to 7; lower where all is dark, higher where all is pale",
    "duty": "LCD: the duty that the module's pins choose, 65, 55, 53, 49 or 33",
    "mirror_x": "1 where left and right are swapped",
    "mirror_y": "1 where top and bottom are swapped",
    "order": "how wires go on from block to block: rows, columns, serpentine, or column.row of each: 0.0,1.0,1.1,0.1",
    "first_block": "corner where the wires come in: top-left, top-right, bottom-left or bottom-right",
    "block_rotation": "degrees by which the text is turned clockwise in every block, or those of each: 0,90,180,270",
    "mirror_blocks": "1 where the text is mirrored in every block",
    "board": "backpack or featherwing, where the picture is scrambled",
    "chained_control": "1 allows control bytes in a chain, which spare bytes and some clones do not take",
}


def table() -> Iterator[str]:
    """List all chips, a line each."""
    rows = [("chip", "on", "levels", "sizes")]
    for name, chip in CHIPS.items():
        sizes = [f"{width}x{height}" for width, height in chip.sizes]
        more = f", ... ({len(sizes)})" if len(sizes) > 4 else ""
        rows.append((name, _buses(chip.buses), str(2**chip.depth), ", ".join(sizes[:4]) + more))
    widths = [max(len(row[column]) for row in rows) for column in range(3)]
    for row in rows:
        yield "  ".join((*(cell.ljust(width) for cell, width in zip(row, widths, strict=False)), row[3]))


def describe(name: str) -> Iterator[str]:
    """Say all of one chip: its sizes, what can be told of its module, and a URL to try.

    Raises
    ------
    ValueError
        There is no such chip.
    """
    chip = CHIPS.get(name.lower())
    if chip is None:
        raise ValueError(f"there is no chip {name!r}; see paneldraw panels{did_you_mean(name.lower(), CHIPS)}")
    yield f"{chip.name}: {chip.about}"
    yield f"on {_buses(chip.buses)}, {2**chip.depth} levels"
    yield f"sizes: {', '.join(f'{width}x{height}' for width, height in chip.sizes)}"
    if does := by_itself(chip()):
        yield f"by itself: {', '.join(does)}"
    yield "parameters of the URL:"
    width = max(map(len, chip.parameters))
    for parameter in chip.parameters:
        yield f"  {parameter.ljust(width)}  {PARAMETERS.get(parameter, '')}".rstrip()
    places = {"i2c": f"i2c://1/{chip.address:#x}", "spi": "spi://0.0"}
    tries = (f"{places[bus.removesuffix('-pair')]}?chip={name.lower()}" for bus in chip.buses)
    yield f"try: {' or '.join(tries)}"


def _buses(buses: tuple[str, ...]) -> str:
    return ", ".join(BUSES[bus] for bus in buses)
