"""MicroPython itself, which comes as an npm package, asked what its framebuf draws.

Run as a script, it writes what the tests compare with where there is no node: ``tests/golden/micropython.txt``.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from array import array
from dataclasses import dataclass
from pathlib import Path
from random import Random

PACKAGE = "@micropython/micropython-webassembly-pyscript"
VERSION = "1.27.0"
TABLE = Path(__file__).parent.parent / "golden" / "micropython.txt"

#: By the names of the formats: bits a pixel, and pixels that a row or column takes whole.
FORMATS = {
    "MONO_VLSB": (1, 1),
    "MONO_HLSB": (1, 8),
    "MONO_HMSB": (1, 8),
    "GS2_HMSB": (2, 4),
    "GS4_HMSB": (4, 2),
    "GS8": (8, 1),
    "RGB565": (16, 1),
}


@dataclass(frozen=True)
class Script:
    """Calls on a buffer of `size` bytes, as text that both Pythons read."""

    size: int
    arguments: str
    calls: str


def drawn(framebuf, script):
    """The buffer after a script's calls, by a module framebuf of this Python."""
    names = dict(vars(framebuf))
    names["buffer"] = bytearray((37 * k + 11) & 255 for k in range(script.size))
    names["fb"] = eval(f"FrameBuffer(buffer, {script.arguments})", names)
    names["array"] = array
    for call in script.calls.split("; "):
        eval(f"fb.{call}", names)
    return bytes(names["buffer"])


#: The same in MicroPython.
THEIRS = """
import json, framebuf
from array import array
names = {name: getattr(framebuf, name) for name in dir(framebuf)}
for size, arguments, calls in json.loads(QUESTIONS):
    own = dict(names)
    own["buffer"] = bytearray((37 * k + 11) & 255 for k in range(size))
    own["fb"] = eval("FrameBuffer(buffer, " + arguments + ")", own)
    own["array"] = array
    for call in calls.split("; "):
        eval("fb." + call, own)
    print(own["buffer"].hex())
"""
DRIVER = """
import {loadMicroPython} from "%s";
import {readFileSync} from "node:fs";
const micropython = await loadMicroPython({heapsize: 64 << 20});
micropython.runPython(readFileSync(0, "utf8"));
"""


class MicroPython:
    """The interpreter, installed by npm into a folder.

    Raises
    ------
    OSError
        There is no node or no npm, or npm brings nothing.
    """

    def __init__(self, folder):
        for tool in ("node", "npm"):
            if shutil.which(tool) is None:
                raise FileNotFoundError(f"there is no {tool}")
        command = ["npm", "install", "--no-audit", "--no-fund", "--prefix", str(folder), f"{PACKAGE}@{VERSION}"]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise OSError(f"npm does not bring MicroPython: {done.stderr.strip()[-300:]}")
        self._driver = folder / "driver.mjs"
        module = folder / "node_modules" / PACKAGE / "micropython.mjs"
        self._driver.write_text(DRIVER % module.as_uri(), encoding="utf-8")

    def run(self, program):
        """What a program prints."""
        done = subprocess.run(["node", str(self._driver)], input=program, capture_output=True, text=True)
        if done.returncode:
            raise ValueError(done.stdout[-1000:] + done.stderr[-2000:])
        return done.stdout

    def drawn(self, scripts):
        """The buffers after the calls of scripts."""
        questions = [[script.size, script.arguments, script.calls] for script in scripts]
        lines = self.run(f"QUESTIONS = {json_literal(questions)}\n{THEIRS}").split()
        assert len(lines) == len(scripts)
        return [bytes.fromhex(line) for line in lines]

    def letters(self):
        """The letters of its font, as `paneldraw.compat.framebuf.font` takes them."""
        program = """if True:
            import framebuf
            for k in range(32, 128):
                cell = bytearray(8)
                framebuf.FrameBuffer(cell, 8, 8, framebuf.MONO_VLSB).text(chr(k), 0, 0)
                print(cell.hex())
        """
        return bytes.fromhex("".join(self.run(program).split()))


def json_literal(value):
    """A literal of a string that holds a value as JSON."""
    import json

    return repr(json.dumps(value))


# -- Scripts at random


class Dice(Random):
    """Arguments at random: mostly around the picture, now and then far off."""

    def script(self, text=False):
        """A few calls on a small picture, in any format."""
        name = self.choice(list(FORMATS))
        width, height = self.randint(1, 21), self.randint(1, 19)
        stride = width + self.choice((0, 0, 0, 1, 5))
        calls = [self.call(width, height, name, text) for _ in range(self.randint(1, 6))]
        arguments = f"{width}, {height}, {name}" + (f", {stride}" if stride > width else "")
        return Script(room(name, width, height, stride), arguments, "; ".join(calls))

    def at(self, size):
        """A coordinate where one side has so many pixels."""
        reach = self.choice((0, 0, 2, 2, 12, 12, 300))
        return self.randint(-reach, size - 1 + reach)

    def color(self):
        return self.choice((0, 1, 1, 1, 2, 3, 5, 10, 15, 200, 255, 0x1234, 0xFFFF, -1))

    def size(self, most):
        return self.choice((0, 1, 2, self.randint(-5, most + 5), self.randint(1, most), self.randint(1, 400)))

    def call(self, width, height, name, text):
        """A call, as text."""
        x, y, c = self.at(width), self.at(height), self.color()
        w, h = self.size(width), self.size(height)
        fill = self.choice((True, False))
        kinds = {
            "fill": lambda: (c,),
            "pixel": lambda: (x, y, c),
            "hline": lambda: (x, y, w, c),
            "vline": lambda: (x, y, h, c),
            "line": lambda: (x, y, self.at(width), self.at(height), c),
            "rect": lambda: (x, y, w, h, c, *self.choice(((), (fill,)))),
            "fill_rect": lambda: (x, y, w, h, c),
            "ellipse": lambda: (x, y, w, h, c, *self.choice(((), (fill,), (fill, self.randint(-1, 16))))),
            "poly": lambda: (x, y, self.polygon(width, height), c, *self.choice(((), (fill,)))),
            "scroll": lambda: (self.randint(-width - 1, width + 1), self.randint(-height - 1, height + 1)),
            "blit": lambda: self.blit(x, y, name),
        }
        if text:
            kinds["text"] = lambda: (ascii(self.words()), x, y, *self.choice(((), (c,))))
        odds = {"fill": 1, "pixel": 2, "line": 5, "ellipse": 5, "poly": 6, "scroll": 3, "blit": 5, "text": 9}
        kind = self.choices(list(kinds), [odds.get(kind, 3) for kind in kinds])[0]
        return f"{kind}({', '.join(map(str, kinds[kind]()))})"

    def polygon(self, width, height):
        reach = self.choice((0, 3, 20))
        numbers = []
        for _ in range(self.randint(0, 7)):
            point = self.randint(-reach, width + reach), self.randint(-reach, height + reach)
            numbers += self.choice((point, point, numbers[-2:] or point))
        numbers += [7] * self.choice((0, 0, 0, 1))
        code = self.choice("hhhbiBH")
        return f"array({code!r}, {[abs(k) if code in 'BH' else k for k in numbers]})"

    def blit(self, x, y, name):
        if self.random() < 0.15:
            return "fb", x, y
        width, height, other = self.randint(1, 9), self.randint(1, 9), self.choice((name, *FORMATS))
        source = self.picture(other, width, height)
        if self.random() < 0.4:
            return source, x, y
        key = self.choice((-1, 0, 0, 1, 3, 15, 255))
        colors = 1 << FORMATS[other][0]
        if colors > 256 or self.random() < 0.5:
            return source, x, y, key, *self.choice(((), (None,)))
        return source, x, y, key, self.picture(self.choice((name, *FORMATS)), colors, 1)

    def picture(self, name, width, height):
        data = bytes(self.choices((0, 255, self.randrange(256)), k=room(name, width, height, width)))
        form = self.choice(("({}, {}, {}, {})", "FrameBuffer(bytearray({}), {}, {}, {})"))
        return form.format(data, width, height, name)

    def words(self):
        return "".join(self.choices("AgÖ€ 0~\x7f\n\x01\0z", k=self.randint(0, 6)))


def room(name, width, height, stride):
    """Bytes that a picture takes."""
    bits, unit = FORMATS[name]
    rows = -(-height // 8) if name == "MONO_VLSB" else height
    pixels = rows * -(-stride // unit) * unit
    return pixels if name == "MONO_VLSB" else pixels * bits // 8


def scripts(seed, count, text=False):
    """So many scripts, the same ones for a seed on every machine."""
    dice = Dice(seed)
    return [dice.script(text) for _ in range(count)]


# -- The table


def table():
    """The scripts and buffers of the table."""
    for line in TABLE.read_text(encoding="utf-8").splitlines():
        if line[:1] not in ("#", ""):
            size, arguments, calls, buffer = line.split(" | ")
            yield Script(int(size), arguments, calls), bytes.fromhex(buffer)


def main():
    asked = scripts(1, 400)
    with tempfile.TemporaryDirectory() as folder:
        answers = MicroPython(Path(folder)).drawn(asked)
    lines = [
        f"# What MicroPython {VERSION} draws: bytes, arguments, calls and the buffer after them; made by",
        f"# {'/'.join(Path(__file__).parts[-3:])}",
    ]
    lines += [
        f"{one.size} | {one.arguments} | {one.calls} | {buffer.hex()}"
        for one, buffer in zip(asked, answers, strict=True)
    ]
    TABLE.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
