"""What several tests of the simulator need."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from paneldraw import simulator

SIZES = [(128, 64), (128, 32), (96, 16), (72, 40), (64, 48), (64, 32), (48, 64)]


def init(width: int, height: int, mode: int = 0x00) -> bytes:
    """The commands that bring a module of a common size up, upright, as its maker prints them."""
    pins = 0x02 if width > 2 * height else 0x12
    return bytes.fromhex(
        f"AE D5 80 A8 {height - 1:02X} D3 00 40 8D 14 20 {mode:02X} A1 C8 DA {pins:02X} 81 CF D9 F1 DB 20 2E A4 A6 AF"
    )


def commands(chip: simulator.SSD1306, text: str) -> None:
    """Send commands written in hex, in one transaction."""
    chip.write(b"\x00" + bytes.fromhex(text))


def offset(width: int) -> int:
    return 0 if width in (128, 96) else (128 - width) // 2


def pack(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Pages of bytes, least significant bit on top."""
    return np.packbits(picture, axis=0, bitorder="little")


def random_picture(width: int, height: int, seed: int, max_level: int = 1) -> NDArray[np.uint8]:
    return np.random.default_rng(seed).integers(0, max_level + 1, (height, width), dtype=np.uint8)


def started(width: int = 128, height: int = 64, mode: int = 0x00, **options: object) -> simulator.SSD1306:
    """A chip after its init, its RAM still noise."""
    chip = simulator.SSD1306(width, height, **options)  # type: ignore[arg-type]
    chip.write(b"\x00" + init(width, height, mode))
    return chip


def send(chip: simulator.SSD1306, picture: NDArray[np.uint8]) -> None:
    """Put a picture in the window of a chip in horizontal addressing mode."""
    height, width = picture.shape
    left = offset(width)
    chip.write(bytes([0x00, 0x21, left, left + width - 1, 0x22, 0, height // 8 - 1]))
    chip.write(b"\x40" + pack(picture).tobytes())


def show_row_numbers(chip: simulator.SSD1306) -> None:
    """Fill the RAM of a 128-column chip so that every line of pixels tells which RAM row it shows."""
    rows = np.zeros((64, 128), np.uint8)
    rows[:, 0] = 1
    rows[:, 1:7] = np.arange(64)[:, None] >> np.arange(6) & 1
    commands(chip, "20 00 21 00 7F 22 00 07")
    chip.write(b"\x40" + pack(rows).tobytes())


def row_numbers(pixels: NDArray[np.uint8]) -> list[int | None]:
    """Which RAM row every line shows, top to bottom; None where the line is dark."""
    return [int(line[1:7] @ (1 << np.arange(6))) if line[0] else None for line in pixels.astype(int)]


class BusioI2C:
    """What ``busio.I2C`` does on Linux, on real smbus2 messages."""

    def __init__(self, bus: simulator.I2CBus) -> None:
        from smbus2 import i2c_msg  # not to be had on Windows, where other things of this file are used

        self.i2c_msg = i2c_msg
        self.bus = bus
        self.locked = False

    def try_lock(self) -> bool:
        taken, self.locked = not self.locked, True
        return taken

    def unlock(self) -> None:
        self.locked = False

    def writeto(self, address: int, buffer: Any, *, start: int = 0, end: int | None = None) -> None:
        assert self.locked
        self.bus.i2c_rdwr(self.i2c_msg.write(address, bytes(buffer[start:end])))

    def writeto_then_readfrom(self, address: int, out: Any, answer: Any, **ends: Any) -> None:
        assert self.locked
        wanted = self.i2c_msg.read(address, len(answer))
        self.bus.i2c_rdwr(self.i2c_msg.write(address, bytes(out)), wanted)
        answer[:] = bytes(wanted)

    def readfrom_into(self, address: int, buffer: Any, *, start: int = 0, end: int | None = None) -> None:
        assert self.locked
        answer = self.i2c_msg.read(address, len(buffer[start:end]))
        self.bus.i2c_rdwr(answer)
        buffer[start:end] = bytes(answer)
