"""Commands as tables: how many arguments an opcode takes, which registers it sets, and what reset gives them.

A command never fails on a chip. What the datasheet forbids is said (`Chip.complain`, `Chip.remark`) and then happens as
far as the register's bits allow.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, field
from typing import Any

Act = Callable[[Any, bytes], None]


@dataclass(frozen=True)
class Command:
    """One command of a chip.

    Attributes
    ----------
    arguments : int
        How many bytes follow the opcode.
    act : callable
        What it does, given the chip and all its bytes, the opcode first.
    registers : mapping of str
        The registers that it sets, and what reset gives them.
    points : bool
        Whether it sets the pointer to where data goes. Default: False.
    """

    arguments: int
    act: Act
    registers: Mapping[str, Any] = field(default_factory=dict)
    points: bool = False


Commands = dict[int, Command]


def setting(
    register: str,
    reset: int,
    legal: Container[int] = range(256),
    rule: str = "",
    *,
    mask: int = 0xFF,
    harmless: bool = False,
) -> Command:
    """One argument goes into one register; a value that is not `legal` is a violation, or a remark if `harmless`."""

    def act(chip: Any, sent: bytes) -> None:
        if sent[1] not in legal:
            (chip.remark if harmless else chip.complain)(rule, sent)
        setattr(chip.registers, register, sent[1] & mask)

    return Command(1, act, {register: reset})


def choice(register: str, reset: Any, values: Mapping[int, Any]) -> Commands:
    """Opcodes that each give a register a value."""

    def command(value: Any) -> Command:
        return Command(0, lambda chip, sent: setattr(chip.registers, register, value), {register: reset})

    return {opcode: command(value) for opcode, value in values.items()}


def switch(register: str, off: int) -> Commands:
    """An opcode that switches off, as reset does, and the next one, which switches on."""
    return choice(register, False, {off: False, off + 1: True})


def numbered(register: str, first: int, count: int, reset: int = 0) -> Commands:
    """Opcodes in a row that carry a number in their low bits."""
    return choice(register, reset, {first + number: number for number in range(count)})


def nothing(arguments: int = 0) -> Command:
    """Take a command, arguments and all, that does nothing to be seen here."""
    return Command(arguments, lambda chip, sent: None)


def relative(whose: str, arguments: int = 0, *, misleads: bool = False) -> Command:
    """Let a command pass, arguments and all, that only relatives of the chip have.

    Parameters
    ----------
    whose : str
        What it is there, for the remark: "charge pump of the SSD1306".
    arguments : int
        How many bytes follow the opcode. Default: 0.
    misleads : bool
        Whether who sends it counts on an effect on the picture: a violation then. Default: False.
    """

    def act(chip: Any, sent: bytes) -> None:
        rule = f"not a command of the {type(chip).__name__} ({whose}); ignored"
        (chip.complain if misleads else chip.remark)(rule, sent)

    return Command(arguments, act)


def _unknown(chip: Any, sent: bytes) -> None:
    chip.complain(f"a command neither of the {type(chip).__name__} nor of its relatives; ignored here", sent)


UNKNOWN = Command(0, _unknown)


def _display_on(chip: Any, sent: bytes) -> None:
    chip.registers.on = True
    if not chip.fed:
        chip.remark(f"display on before the panel has a supply ({chip.supply_command})", sent)


#: The switch that all displays have.
DISPLAY: Commands = {**switch("on", 0xAE), 0xAF: Command(0, _display_on)}


def _lock(chip: Any, sent: bytes) -> None:
    if sent[1] not in (0x12, 0x16):
        chip.complain("the command lock takes 12 (open) or 16 (locked)", sent)
    chip.registers.locked = bool(sent[1] & 0x04)


#: The command lock of later Solomon chips: while locked, they take nothing but the key.
LOCK = Command(1, _lock, {"locked": False})
