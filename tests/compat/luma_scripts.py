"""Run scripts of luma.examples on a simulated panel, with luma and with paneldraw's face of it.

``python luma_scripts.py EXAMPLES/examples`` prints which scripts show the same pixels, and the bytes of each. The
scripts are others' property and not here: ``git clone https://github.com/rm-hull/luma.examples``.
"""

from __future__ import annotations

import importlib
import io
import json
import os
import random
import re
import runpy
import shutil
import subprocess
import sys
import tempfile
import zlib
from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any, ClassVar, NamedTuple

import numpy as np

FRAMES = 40
"""Pictures after which a script is ended."""
DISPLAYS = {
    "ssd1306": ("SSD1306", (128, 64), "i2c", []),
    "ssd1306-turned": ("SSD1306", (128, 64), "i2c", ["--display", "ssd1306", "--rotate", "1"]),
    "ssd1327": ("SSD1327", (128, 128), "i2c", []),
    "ssd1322": ("SSD1322", (256, 64), "spi", []),
    "max7219": ("MAX7219", (64, 8), "spi", ["--display", "max7219", "--block-orientation", "-90"]),
}
OTHER_DISPLAYS = {"sevensegment_demo": "max7219", "dotmatrixtool": "max7219"}
NO_SCRIPTS = {"demo_opts"}
EPOCH = 1_780_000_000.0


class Result(NamedTuple):
    """What a script did."""

    frames: list[tuple[int, int]]
    """Of each picture a checksum of the pixels, and the contrast."""
    wire_bytes: int
    error: str

    @property
    def pictures(self) -> list[int]:
        """The checksums."""
        return [checksum for checksum, _ in self.frames]


class Enough(KeyboardInterrupt):
    """A script showed what it was to show."""


def moved(source: str) -> str:
    """Return a script's text with luma's imports changed, and nothing else."""
    source = re.sub(r"^(\s*)from luma\b", r"\1from paneldraw.compat.luma", source, flags=re.MULTILINE)
    both = r"\1import paneldraw.compat.luma\2; from paneldraw.compat import luma"
    return re.sub(r"^(\s*)import luma(\S*)$", both, source, flags=re.MULTILINE)


def moved_folder(examples: Path, folder: Path) -> Path:
    """Copy the scripts with their imports changed."""
    target = folder / "examples"
    shutil.copytree(examples, target)
    for file in target.rglob("*.py"):
        file.write_text(moved(file.read_text("utf-8")), "utf-8")
    return target


def run(examples: Path, script: str, face: str, display: str) -> Result:
    """Run a script in a process of its own; `face` is the package that has ``core.cmdline``."""
    command = [sys.executable, "-W", "ignore", __file__, "--inside", script, face, display]
    path = os.pathsep.join(filter(None, sys.path))  # the same paneldraw as here
    environment = {**os.environ, "PYTHONHASHSEED": "0", "PYTHONPATH": path}
    done = subprocess.run(command, capture_output=True, text=True, timeout=250, cwd=examples, env=environment)
    if done.returncode:
        return Result([], 0, done.stderr.strip().splitlines()[-1] if done.stderr else f"exit {done.returncode}")
    frames, wire_bytes, error = json.loads(done.stdout.rpartition("\n@")[2])
    return Result([tuple(frame) for frame in frames], wire_bytes, error)


# -- In that process


class Time:
    """A clock that stands still but for pauses and pictures; a script that pauses for an hour has shown enough."""

    def __init__(self) -> None:
        self.now = 10**9  # nanoseconds
        self.events: list[Callable[[], object]] = []

    def seconds(self) -> float:
        return self.now / 1e9

    def date(self) -> float:
        return EPOCH + self.seconds()

    def sleep(self, seconds: float) -> None:
        self.now += round(max(0.0, seconds) * 1e9)
        if self.seconds() > 3600:
            raise Enough
        events, self.events = self.events, []  # which may pause, too
        for event in events:
            event()
        self.events += events

    def install(self) -> None:
        import datetime
        import time

        clock = self

        class Datetime(datetime.datetime):
            @classmethod
            def now(cls, tz: Any = None) -> Any:
                return cls.fromtimestamp(clock.date(), tz)

        datetime.datetime = Datetime  # type: ignore[misc]
        time.time = self.date
        time.monotonic = time.perf_counter = self.seconds
        time.perf_counter_ns = lambda: self.now
        time.sleep = self.sleep


def stubs(clock: Time) -> None:
    """Put something in the place of what a script wants of the network, a camera and the machine it is on."""
    numbers = count()
    usage = SimpleNamespace(used=3 << 30, total=8 << 30, percent=37.5, free=5 << 30, available=5 << 30)
    traffic = {name: SimpleNamespace(bytes_sent=1 << 22, bytes_recv=1 << 24) for name in ("wlan0", "eth0", "lo")}
    import socket

    address = {"eth0": [SimpleNamespace(address="192.168.1.2", family=socket.AF_INET)]}
    module(
        "psutil",
        boot_time=lambda: EPOCH - 100_000,
        cpu_percent=lambda interval=None, percpu=False: [20 + next(numbers) % 60, 30] if percpu else 42.0,
        virtual_memory=lambda: usage,
        swap_memory=lambda: usage,
        disk_usage=lambda path: usage,
        net_io_counters=lambda pernic=False: traffic,
        net_if_addrs=lambda: address,
        net_if_stats=lambda: {name: SimpleNamespace(isup=True, duplex=2) for name in address},
    )
    os.getloadavg = lambda: (0.5, 0.7, 0.9)
    subprocess.getoutput = lambda command: "temp=48.3'C"
    price = {"last": "61234.00", "high": "62000.00", "low": "60100.00"}
    module("requests", get=lambda url: SimpleNamespace(json=lambda: price))
    day = {"title": "Monday: Sunny, Maximum 21", "description": "Wind: 5mph, Humidity: 60%"}
    module("feedparser", parse=lambda url: {"feed": {"title": "Weather"}, "items": [day]})
    module("av", open=lambda path: SimpleNamespace(decode=lambda video: map(Film, range(FRAMES))))
    module("picamera", PiCamera=Camera)
    module("pusherclient", Pusher=lambda key: Pusher(clock))
    module(
        "tweepy",
        StreamListener=object,
        OAuthHandler=lambda *keys: SimpleNamespace(set_access_token=lambda *keys: None),
        API=lambda auth: SimpleNamespace(auth=auth),
        Stream=Tweets,
    )


def module(name: str, **members: Any) -> None:
    sys.modules[name] = ModuleType(name)
    vars(sys.modules[name]).update(members)


class Film:
    """A frame of a film: a disc that moves."""

    def __init__(self, number: int) -> None:
        self.number = number

    def to_image(self) -> Any:
        from PIL import Image, ImageDraw

        image = Image.new("RGB", (320, 240), (20, 40, 80))
        ImageDraw.Draw(image).ellipse((4 * self.number, 60, 4 * self.number + 90, 150), fill=(255, 200, 40))
        return image


class Camera:
    def __enter__(self) -> Camera:
        return self

    def __exit__(self, *exception: object) -> None:
        pass

    def start_preview(self) -> None:
        pass

    close = start_preview

    def capture(self, stream: io.BytesIO, format: str, resize: tuple[int, int]) -> None:
        Film(9).to_image().resize(resize).save(stream, "PNG")

    def capture_sequence(self, streams: Iterator[io.BytesIO], resize: tuple[int, int], **more: Any) -> None:
        for number, stream in zip(range(FRAMES), streams, strict=False):
            while stream.getbuffer().nbytes:  # another picture of it is still being shown
                PAUSE(0.001)
            Film(number).to_image().resize(resize).save(stream, "PNG")
            Camera.shown += 1
            if number:
                while len(Panel.frames) < number:
                    PAUSE(0.001)
        raise Enough

    shown = 0


class Pusher:
    """A connection over which a trade comes with every pause of the script."""

    def __init__(self, clock: Time) -> None:
        self._clock = clock
        self.connection = SimpleNamespace(bind=self._bind)

    def _bind(self, event: str, handler: Callable[[str], object]) -> None:
        self._connected: Callable[[str], object] | None = handler

    def connect(self) -> None:
        self._clock.events.append(self._greet)

    def _greet(self) -> None:
        if self._connected is not None:
            connected, self._connected = self._connected, None
            connected("")

    def subscribe(self, channel: str) -> Any:
        return SimpleNamespace(bind=self._trade)

    def _trade(self, event: str, handler: Callable[[str], object]) -> None:
        numbers = count(1)
        trade = lambda: json.dumps({"price_str": f"{2190 + next(numbers)}.00", "amount": 0.25})  # noqa: E731
        self._clock.events.append(lambda: handler(trade()))

    def disconnect(self) -> None:
        pass


class Tweets:
    def __init__(self, auth: object, listener: Any) -> None:
        self.listener = listener

    def filter(self, **more: object) -> None:
        for text in ("Hello, panel", "A second one"):
            self.listener.on_status(SimpleNamespace(author=SimpleNamespace(screen_name="someone"), text=text))

    def disconnect(self) -> None:
        pass


class Panel:
    """The simulated panel, and what a device displayed on it."""

    frames: ClassVar[list[tuple[int, int]]] = []

    def __init__(self, display: str, clock: Time) -> None:
        from paneldraw import simulator

        chip, size, self.kind, more = DISPLAYS[display]
        wiring: dict[str, Any] = {}
        if chip == "MAX7219":
            wiring = {"first_block": "top-left", "block_rotation": 180}
        self.chip = getattr(simulator, chip)(*size, **wiring)
        self.clock = clock
        self.arguments = more or ["--display", display]
        self.arguments += ["--width", str(size[0]), "--height", str(size[1])]
        if self.kind == "spi":
            import spidev

            lines: dict[str, Any] = {"dc": None, "reset": None} if chip == "MAX7219" else {}
            bus = simulator.SPIBus(self.chip, timer=None, **lines)
            spidev.SpiDev = lambda: bus.spi
            module("lines", BCM=11, OUT=0, **{name: getattr(bus.gpio, name) for name in ("setmode", "setup", "output")})
            sys.modules["lines"].cleanup = lambda *pins: None  # type: ignore[attr-defined]
            self.arguments += ["--interface", "spi", "--gpio", "lines"]
        else:
            import smbus2

            bus = simulator.I2CBus({0x3C: self.chip}, timer=None)
            smbus2.SMBus = lambda *path: bus
        self.bus = bus

    def watch(self, face: str) -> None:
        """Note what each device shows that the command line makes."""
        cmdline = importlib.import_module(f"{face}.core.cmdline")
        create: Callable[..., Any] = cmdline.create_device

        def created(*arguments: Any) -> Any:
            device = create(*arguments)
            random.seed(1)  # whatever was drawn by what was imported
            show = device.display

            def display(image: Any) -> None:
                show(image)
                self.clock.sleep(0.005)
                self.frames.append((zlib.crc32(self.chip.pixels.tobytes()), int(self.chip.contrast)))
                if len(self.frames) >= FRAMES:
                    raise Enough

            device.display = display
            return device

        cmdline.create_device = created


def main(script: str, face: str, display: str) -> None:
    """Run a script here and print what it did."""
    import PIL.ImageFont

    clock = Time()
    panel = Panel(display, clock)
    clock.install()
    stubs(clock)
    truetype = PIL.ImageFont.truetype

    def font(name: Any, *arguments: Any, **more: Any) -> Any:
        if "code2000" in str(name) and not Path(name).exists():
            name = str(Path(name).with_name("DejaVuSansMono.ttf"))
        return truetype(name, *arguments, **more)

    PIL.ImageFont.truetype = font
    panel.watch(face)
    random.seed(1)
    np.random.seed(1)
    os.urandom = random.randbytes
    sys.argv = [script, *panel.arguments]
    sys.path.insert(0, os.getcwd())
    error = ""
    try:
        runpy.run_path(f"{script}.py", run_name="__main__")
    except (KeyboardInterrupt, SystemExit) as end:
        error = "" if isinstance(end, KeyboardInterrupt) or not end.code else str(end.code)
    except Exception as wrong:
        error = f"{type(wrong).__name__}: {wrong}"
    print(f"\n@{json.dumps((panel.frames, panel.bus.bytes, error))}", flush=True)
    os._exit(0)


def report(examples: Path, scripts: list[str], displays: list[str]) -> None:
    """Print a line a script and display."""
    with tempfile.TemporaryDirectory() as folder:
        ours = moved_folder(examples, Path(folder))
        for script in scripts or sorted(file.stem for file in examples.glob("*.py")):
            for display in displays:
                display = OTHER_DISPLAYS.get(script, display)
                if script not in NO_SCRIPTS:
                    a, b = run(examples, script, "luma", display), run(ours, script, "paneldraw.compat.luma", display)
                    same = a.pictures == b.pictures and a.pictures
                    what = "same" if same else "DIFFERENT"
                    less = "fewer" if b.wire_bytes < a.wire_bytes else "MORE"
                    sizes = f"{len(a.frames):3} pictures {a.wire_bytes:8} {b.wire_bytes:8} {less}"
                    print(f"{script:20} {display:8} {what:9} {sizes} {a.error} {b.error}", flush=True)


if __name__ == "__main__":
    import time

    PAUSE = time.sleep
    if sys.argv[1] == "--inside":
        main(*sys.argv[2:])
    else:
        report(Path(sys.argv[1]), sys.argv[2:3], sys.argv[3:] or ["ssd1306", "ssd1327"])
