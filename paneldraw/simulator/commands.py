"""Commands as the chips of this package have them: how many arguments they take, and what they do to registers.

A command never fails on a chip. What the datasheet forbids is handed to ``complain``, and then happens as far as
the register's bits allow.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from typing import Any, NamedTuple

Complain = Callable[[str], None]
Act = Callable[[Any, Sequence[int], Complain], None]


class Command(NamedTuple):
    """How many argument bytes a command takes, and what it does once they are there (the opcode is byte 0)."""

    arguments: int
    act: Act


class Setting(NamedTuple):
    """A command whose one argument goes into one register."""

    register: str
    mask: int = 0xFF
    legal: Container[int] = range(256)
    rule: str = ""


#: What the SSD130x, the SH110x and the SSD1327 have in common: the switches of the display.
DISPLAY: dict[int, tuple[str, object]] = {0xAE: ("on", False), 0xAF: ("on", True)}

#: What the SSD130x and the SH110x have in common besides: how the RAM comes to the glass, and the timing.
MIRRORS: dict[int, tuple[str, object]] = {
    0xA0: ("segment_remap", False),
    0xA1: ("segment_remap", True),
    0xA4: ("all_on", False),
    0xA5: ("all_on", True),
    0xA6: ("inverted", False),
    0xA7: ("inverted", True),
    0xC0: ("com_reversed", False),
    0xC8: ("com_reversed", True),
}
TIMING = {
    0x81: Setting("contrast"),
    0xD3: Setting("offset", 0x3F, range(64), "the display offset is 00 to 3F"),
    0xD5: Setting("clock"),
    0xD9: Setting(
        "precharge",
        legal=[n for n in range(256) if n & 0x0F and n & 0xF0],
        rule="a precharge phase of 0 clocks is invalid",
    ),
}


def start_line(registers: Any, sent: Sequence[int], complain: Complain) -> None:
    """Begin with that row of the RAM: 40 to 7F, of the SSD130x and the SH1106."""
    registers.start_line = sent[0] & 0x3F


def written(sent: Sequence[int]) -> str:
    """Bytes as violations spell them."""
    return " ".join(f"{byte:02X}" for byte in sent)


def setting(spec: Setting) -> Act:
    """Put the argument into a register."""

    def act(registers: Any, sent: Sequence[int], complain: Complain) -> None:
        if sent[1] not in spec.legal:
            complain(f"{written(sent)}: {spec.rule}")
        setattr(registers, spec.register, sent[1] & spec.mask)

    return act


def flag(register: str, value: object) -> Act:
    """Give a register a value."""

    def act(registers: Any, sent: Sequence[int], complain: Complain) -> None:
        setattr(registers, register, value)

    return act


def foreign(chip: str, name: str = "") -> Act:
    """Let a command pass, argument and all, that is none of the chip's."""
    whose = f" ({name})" if name else ""

    def act(registers: Any, sent: Sequence[int], complain: Complain) -> None:
        complain(f"{written(sent)}: not a command of the {chip}{whose}; ignored")

    return act


def nothing(registers: Any, sent: Sequence[int], complain: Complain) -> None:
    """Do nothing."""


def table(
    chip: str,
    settings: Mapping[int, Setting],
    flags: Mapping[int, tuple[str, object]],
    others: Mapping[int, Command],
) -> tuple[Command, ...]:
    """All 256 commands of a chip; those not named are unknown to it."""
    commands = [Command(0, foreign(chip))] * 256
    for opcode, spec in settings.items():
        commands[opcode] = Command(1, setting(spec))
    for opcode, (register, value) in flags.items():
        commands[opcode] = Command(0, flag(register, value))
    for opcode, command in others.items():
        commands[opcode] = command
    return tuple(commands)
