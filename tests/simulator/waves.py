"""What a logic analyzer would have sampled of known messages, with jitter, and the files that programs make of it."""

from __future__ import annotations

import io
import random
import zipfile
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

import numpy as np

from paneldraw.simulator.log import Call, Select

RATE = 2_000_000


class Wave:
    """Levels of some lines, sample by sample; every level lasts a little longer or shorter than the one before."""

    def __init__(self, levels: Sequence[int], seed: int = 1) -> None:
        self.levels = list(levels)
        self.samples: list[int] = []
        self._random = random.Random(seed)

    def hold(self, **changed: int) -> None:
        """Put lines at levels, one after the other, and let some time pass."""
        for line, level in changed.items():
            self.levels[int(line[1:])] = level
        word = sum(level << bit for bit, level in enumerate(self.levels))
        self.samples += [word] * self._random.randint(2, 4)

    def rest(self, until: float) -> None:
        """Let time pass until so many seconds."""
        word = sum(level << bit for bit, level in enumerate(self.levels))
        self.samples += [word] * max(int(until * RATE) - len(self.samples), 8)


def i2c(calls: Iterable[Call], seed: int = 1) -> list[int]:
    """Sample an I2C bus: bit 0 is SCL, bit 1 is SDA."""
    wave = Wave([1, 1], seed)
    for call in calls:
        wave.rest(call.seconds)
        for number, message in enumerate(call.messages):
            if number:  # a repeated START
                wave.hold(_1=1)
                wave.hold(_0=1)
            wave.hold(_1=0)
            wave.hold(_0=0)
            for byte in (message.address << 1 | message.read, *message.payload):
                for bit in range(7, -1, -1):
                    _bit(wave, byte >> bit & 1)
                _bit(wave, not message.acknowledged)
        wave.hold(_1=0)
        wave.hold(_0=1)
        wave.hold(_1=1)
    wave.rest(0)
    return wave.samples


def _bit(wave: Wave, level: int) -> None:
    wave.hold(_1=level)
    wave.hold(_0=1)
    wave.hold(_0=0)


def spi(selects: Iterable[Select], seed: int = 1) -> list[int]:
    """Sample an SPI bus: CLK, MOSI, CS and D/C from bit 0 on."""
    wave = Wave([0, 0, 1, 0], seed)
    for select in selects:
        wave.rest(select.seconds)
        wave.hold(_2=0)
        for data, run in select.runs:
            wave.hold(_3=bool(data))
            for byte in run:
                for bit in range(7, -1, -1):
                    wave.hold(_0=0, _1=byte >> bit & 1)
                    wave.hold(_0=1)
                wave.hold(_0=0)
        wave.hold(_2=1)
    wave.rest(0)
    return wave.samples


def session(samples: Sequence[int], names: Sequence[str], *, parts: int = 3, unitsize: int = 1) -> bytes:
    """A sigrok session file, its samples in parts as sigrok-cli writes them."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("version", "2")
        probes = "".join(f"probe{number}={name}\n" for number, name in enumerate(names, 1))
        archive.writestr(
            "metadata",
            "[global]\nsigrok version=0.5.2\n\n[device 1]\ncapturefile=logic-1\n"
            f"total probes={len(names)}\nsamplerate=2 MHz\ntotal analog=0\n{probes}unitsize={unitsize}\n",
        )
        raw = np.array(samples, "<u8").view(np.uint8).reshape(-1, 8)[:, :unitsize].tobytes()
        size = len(raw) // parts + 1  # not a whole number of samples, perhaps
        for number in range(parts):
            archive.writestr(f"logic-1-{number + 1}", raw[number * size : (number + 1) * size])
    return file.getvalue()


def changes(samples: Sequence[int]) -> Iterator[tuple[int, int]]:
    """The samples that differ from those before, with their numbers."""
    at = 0
    for word, run in groupby(samples):
        yield at, word
        at += sum(1 for _ in run)


def saleae_digital(samples: Sequence[int], names: Sequence[str]) -> str:
    """Digital channels as Logic 2 exports them."""
    rows = (
        ",".join([f"{at / RATE:.9f}", *(str(word >> bit & 1) for bit in range(len(names)))])
        for at, word in changes(samples)
    )
    return "\n".join([f"Time [s],{','.join(names)}", *rows, ""])


def saleae_table(calls: Iterable[Call]) -> str:
    """A table of Logic 2's I2C analyzer."""
    rows = ['name,type,start_time,duration,"ack","address","read","data"']
    for call in calls:
        for message in call.messages:
            ack, read = str(message.acknowledged).lower(), str(message.read).lower()
            rows.append(f'"I2C","start",{call.seconds},4.16666667e-08,,,,')
            rows.append(f'"I2C","address",{call.seconds},8.67916667e-05,{ack},0x{message.address:02X},{read},')
            rows += [f'"I2C","data",{call.seconds},8.67916667e-05,true,,,0x{byte:02X}' for byte in message.payload]
        rows.append(f'"I2C","stop",{call.seconds},4.16666667e-08,,,,')
    return "\n".join([*rows, ""])


def kernel_trace(calls: Iterable[Call], bus: int = 1) -> str:
    """What the kernel's tracepoints say of calls, in ftrace's text."""
    rows = ["# tracer: nop", "#", "#           TASK-PID     CPU#  |||||  TIMESTAMP  FUNCTION"]
    for call in calls:
        head = f"          python-1234    [001] .....  {call.seconds:.6f}: i2c_"
        replies = []
        for number, (address, payload, read, _) in enumerate(call.messages):
            said = f"i2c-{bus} #{number} a={address:03x} f={int(read):04x} l={len(payload)}"
            shown = f" [{'-'.join(f'{byte:02x}' for byte in payload[:64])}]"
            rows.append(f"{head}read: {said}" if read else f"{head}write: {said}{shown}")
            if read:
                replies.append(f"{head}reply: {said}{shown}")
        nobody = not all(message.acknowledged for message in call.messages)
        count = len(call.messages)
        rows += [*replies, f"{head}result: i2c-{bus} n={count} ret={-121 if nobody else count}"]
    return "\n".join([*rows, ""])
