"""Commands as tables: how many arguments an opcode takes, which registers it sets, and what reset gives them.

A command never fails on a chip. What the datasheet forbids is said (`Chip.complain`, `Chip.remark`) and then happens as
far as the register's bits allow.
"""

from __future__ import annotations

import string
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

Act = Callable[[Any, bytes], None]


class _Reading(string.Formatter):
    """Fills a command's name with its bytes and the chip's registers, switches and modes in words."""

    def get_value(self, key: int | str, args: Sequence[Any], kwargs: Mapping[str, Any]) -> Any:
        value = super().get_value(key, args, kwargs)
        if isinstance(value, bool):
            return "on" if value else "off"
        return ("horizontal", "vertical", "page")[value] if key == "mode" and value in range(3) else value


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
    name : str or callable, optional
        What it is, for a transcript: ``{contrast}`` is a register once it is obeyed, ``{1}`` the first argument; or
        what finds the name, given the chip and the command's bytes. Default: the registers that it sets, and what they
        hold.
    """

    arguments: int
    act: Act
    registers: Mapping[str, Any] = field(default_factory=dict)
    points: bool = False
    name: str | Callable[[Any, bytes], str] = ""

    def reading(self, chip: Any, sent: bytes) -> str:
        """What the command is, in words, once the chip has obeyed it."""
        if callable(self.name):
            return self.name(chip, sent)
        name = self.name or ", ".join(f"{register.replace('_', ' ')} {{{register}}}" for register in self.registers)
        return _Reading().vformat(name, sent, vars(chip.registers))


Commands = dict[int, Command]


def setting(
    register: str,
    reset: int,
    legal: Container[int] = range(256),
    rule: str = "",
    *,
    mask: int = 0xFF,
    harmless: bool = False,
    name: str = "",
) -> Command:
    """One argument goes into one register; a value that is not `legal` is a violation, or a remark if `harmless`."""

    def act(chip: Any, sent: bytes) -> None:
        if sent[1] not in legal:
            (chip.remark if harmless else chip.complain)(rule, sent)
        setattr(chip.registers, register, sent[1] & mask)

    return Command(1, act, {register: reset}, name=name)


def choice(register: str, reset: Any, values: Mapping[int, Any], name: str = "") -> Commands:
    """Opcodes that each give a register a value."""

    def command(value: Any) -> Command:
        return Command(0, lambda chip, sent: setattr(chip.registers, register, value), {register: reset}, name=name)

    return {opcode: command(value) for opcode, value in values.items()}


def switch(register: str, off: int, name: str = "") -> Commands:
    """An opcode that switches off, as reset does, and the next one, which switches on."""
    return choice(register, False, {off: False, off + 1: True}, name)


def numbered(register: str, first: int, count: int, reset: int = 0) -> Commands:
    """Opcodes in a row that carry a number in their low bits."""
    return choice(register, reset, {first + number: number for number in range(count)})


def nothing(name: str, arguments: int = 0) -> Command:
    """Take a command, arguments and all, that does nothing to be seen here."""
    return Command(arguments, lambda chip, sent: None, name=name)


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

    return Command(arguments, act, name=whose)


def _unknown(chip: Any, sent: bytes) -> None:
    chip.complain(f"a command neither of the {type(chip).__name__} nor of its relatives; ignored here", sent)


UNKNOWN = Command(0, _unknown, name="unknown")


def _display_on(chip: Any, sent: bytes) -> None:
    chip.registers.on = True
    if not chip.fed:
        chip.remark(f"display on before the panel has a supply ({chip.supply_command})", sent)


#: The switch that all displays have.
DISPLAY: Commands = {**switch("on", 0xAE, "display {on}"), 0xAF: Command(0, _display_on, name="display {on}")}


def _lock(chip: Any, sent: bytes) -> None:
    if sent[1] not in (0x12, 0x16):
        chip.complain("the command lock takes 12 (open) or 16 (locked)", sent)
    chip.registers.locked = bool(sent[1] & 0x04)


#: The command lock of later Solomon chips: while locked, they take nothing but the key.
LOCK = Command(1, _lock, {"locked": False}, name="command lock {locked}")
