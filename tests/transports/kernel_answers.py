"""Asks a kernel, real or played, what kernel_answers.txt has, in its words.

``rdwr`` with messages such as ``w3c/2`` (write two bytes to 3c) and ``42*r3c/4`` (read four, 42 times), where t is an
address of ten bits, l a read that begins with its length, and ! a buffer nowhere; ``slave``, ``force``, ``ten``,
``pec``, ``retries``, ``timeout``, ``funcs``, ``ioctl``; ``read``, ``write``; ``smbus`` with direction, kind, and count.
"""

from __future__ import annotations

import ctypes
import errno
import fcntl
import os
import re
import sys
from pathlib import Path

TABLE = Path(__file__).with_name("kernel_answers.txt")
NUMBERS = {"retries": 0x0701, "timeout": 0x0702, "slave": 0x0703, "ten": 0x0704, "force": 0x0706, "pec": 0x0708}
FUNCS, RDWR, SMBUS = 0x0705, 0x0707, 0x0720
KINDS = ("quick", "byte", "data", "word", "call", "block", "broken", "blockcall", "i2c")
DIRECTIONS = {"write": 0, "read": 1, "both": 2}
FLAGS = {"r": 0x0001, "t": 0x0010, "l": 0x0400}
NOWHERE = 0x10


class Message(ctypes.Structure):
    _fields_ = (
        ("addr", ctypes.c_uint16),
        ("flags", ctypes.c_uint16),
        ("len", ctypes.c_uint16),
        ("buf", ctypes.c_void_p),
    )


class Messages(ctypes.Structure):
    _fields_ = (("msgs", ctypes.POINTER(Message)), ("nmsgs", ctypes.c_uint32))


class Transfer(ctypes.Structure):
    _fields_ = (
        ("read_write", ctypes.c_uint8),
        ("command", ctypes.c_uint8),
        ("size", ctypes.c_uint32),
        ("data", ctypes.c_void_p),
    )


def rows():
    """The table: requests and their answers."""
    lines = TABLE.read_text(encoding="ascii").splitlines()
    return [tuple(line.split(" -> ")) for line in lines if line and not line.startswith("#")]


class Asker:
    """One that asks of a path, through functions that `os` and `fcntl` have."""

    def __init__(self, path, files=os, ioctl=fcntl.ioctl):
        self.path, self.files, self._call = path, files, ioctl

    def answer(self, request):
        """What the kernel says to a row's request."""
        self.fd = self.files.open(self.path, os.O_RDWR)
        try:
            return "; ".join(self._step(*step.split()) for step in request.split(";")).strip()
        finally:
            self.files.close(self.fd)

    def _step(self, name, *words):
        self.filled = b""
        try:
            result = getattr(self, f"_{name}")(*words) if hasattr(self, f"_{name}") else self._number(name, *words)
        except OSError as error:
            result = errno.errorcode[error.errno].replace("ENOTSUP", "EOPNOTSUPP")  # two names of one number
            self.filled = self.filled.strip(b"\0")
        return f"{result} {shown(self.filled)}".strip() if isinstance(result, (int, str)) else shown(result)

    def _number(self, name, value):
        number = int(value, 16 if name in ("slave", "force") else 10)
        return self._call(self.fd, NUMBERS[name], number)

    def _ioctl(self, request):
        return self._call(self.fd, int(request, 16), 0)

    def _funcs(self, where=""):
        answer = ctypes.c_ulong()
        if self._call(self.fd, FUNCS, NOWHERE if where else answer):
            return "?"
        return f"{answer.value:08x}"

    def _read(self, count):
        return self.files.read(self.fd, int(count))

    def _write(self, count):
        return self.files.write(self.fd, bytes(int(count)))

    def _rdwr(self, *words):
        if words in (("null",), ("nowhere",)):
            return self._call(self.fd, RDWR, NOWHERE if words == ("null",) else Messages(None, 1))
        made = [message for word in words for message in messages(word)]
        call = Messages((Message * len(made))(*[message for message, _ in made]), len(made))
        try:
            return self._call(self.fd, RDWR, call)
        finally:
            self.filled = b"".join(buffer.raw[: message.len] for message, buffer in made if message.flags & 1)

    def _smbus(self, direction, kind="", count=None):
        if direction == "null":
            return self._call(self.fd, SMBUS, NOWHERE)
        size = int(kind[4:]) if kind.startswith("size") else KINDS.index(kind)
        union = None if count is None else ctypes.create_string_buffer(bytes((int(count),)), 34)
        place = None if union is None else ctypes.addressof(union)
        result = self._call(self.fd, SMBUS, Transfer(DIRECTIONS[direction], 7, size, place))
        if DIRECTIONS[direction] or kind == "call":
            used = {"quick": 0, "word": 2, "call": 2, "i2c": 1, "broken": 1}.get(kind, 1)
            blocks = union.raw[0] if kind in ("i2c", "broken") else 0
            self.filled = union.raw[: used + blocks] if union else b""
        return result


def messages(word):
    """Messages of a word, each beside its buffer."""
    times, kind, address, length = re.fullmatch(r"(?:(\d+)\*)?([rwtl!]+)([0-9a-f]+)/(\d+)", word).groups()
    made = []
    for _ in range(int(times or 1)):
        buffer = ctypes.create_string_buffer(max(int(length), 1))
        place = NOWHERE if kind == "!" else ctypes.addressof(buffer)
        flags = sum(FLAGS.get(letter, 0) for letter in kind)
        made.append((Message(int(address, 16), flags, int(length), place), buffer))
    return made


def shown(data):
    """Bytes in hex, or how many there are."""
    return data.hex() if len(data) <= 8 else f"{len(data)} bytes"


if __name__ == "__main__":
    asker = Asker(sys.argv[1])
    for request, _ in rows():
        print(f"{request} -> {asker.answer(request)}", flush=True)
