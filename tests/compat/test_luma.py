"""luma's face beside luma: the same scripts, the same pixels, fewer bytes."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
import types
from collections.abc import Callable
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import smbus2
from hypothesis import given
from hypothesis import strategies as st
from luma_scripts import moved, moved_folder, run
from PIL import Image, ImageDraw

from paneldraw import simulator
from paneldraw.compat.luma.core import cmdline, error, sprite_system, virtual
from paneldraw.compat.luma.core.device import dummy
from paneldraw.compat.luma.core.interface.serial import i2c, noop, spi
from paneldraw.compat.luma.core.legacy import font as legacy_font
from paneldraw.compat.luma.core.render import canvas
from paneldraw.compat.luma.lcd.device import pcd8544
from paneldraw.compat.luma.led_matrix import segment_mapper
from paneldraw.compat.luma.led_matrix.device import max7219
from paneldraw.compat.luma.oled.device import sh1106, ssd1306, ssd1322

pytestmark = pytest.mark.filterwarnings("ignore:Image.Image.getdata is deprecated")

FACES = ("luma", "paneldraw.compat.luma")
GRAY = {"SSD1322", "SSD1325", "SSD1327", "SSD1362"}
# Chip, size, wiring of the glass that luma means, and the library.
MODULES: list[tuple[str, tuple[int, int], dict[str, Any], str]] = [
    *(("SSD1306", size, {}, "oled") for size in [(128, 64), (128, 32), (96, 16), (64, 48), (64, 32)]),
    ("SSD1315", (128, 64), {}, "oled"),
    ("SSD1305", (128, 64), {"column_offset": 0}, "oled"),
    ("SSD1305", (128, 32), {}, "oled"),
    ("SSD1309", (128, 64), {}, "oled"),
    ("SSD1316", (128, 32), {"com_pins": 0x02}, "oled"),
    ("SH1106", (128, 64), {}, "oled"),
    *(("SH1107", (width, 128), {}, "oled") for width in (64, 80, 128)),
    ("CH1115", (128, 64), {"column_offset": 2}, "oled"),
    ("SSD1322", (256, 64), {}, "oled"),
    ("SSD1325", (128, 64), {}, "oled"),
    ("SSD1327", (128, 128), {}, "oled"),
    ("SSD1362", (256, 64), {}, "oled"),
    ("PCD8544", (84, 48), {}, "lcd"),
    ("ST7567", (128, 64), {}, "lcd"),
    ("UC1701", (128, 64), {}, "lcd"),
    ("MAX7219", (32, 8), {"first_block": "top-left", "block_rotation": 270}, "led_matrix"),
]
NAMES = {"UC1701": "uc1701x"}
TURNED_WRONG = {"CH1115", "ST7567", "UC1701"}
"""Chips whose pictures luma shears where they are turned by a quarter."""
WHITE_ONLY = {"SH1107"}
"""Of a color other than white luma shows the lowest bit here, and not that it is not black."""
ON_SPI = {"SSD1322", "SSD1325", "PCD8544", "ST7567", "UC1701", "MAX7219"}


class Rig:
    """A simulated module and a device of one of the faces on it."""

    def __init__(self, face: str, module: tuple[str, tuple[int, int], dict[str, Any], str], **options: Any) -> None:
        name, size, wiring, library = module
        self.face = face
        self.chip = getattr(simulator, name)(*size, **wiring)
        serial = self("core.interface.serial")
        if name in ON_SPI:
            lines: dict[str, Any] = {"dc": None, "reset": None} if name == "MAX7219" else {}
            self.bus: Any = simulator.SPIBus(self.chip, timer=None, **lines)
            gpio = serial.noop() if name == "MAX7219" else self.bus.gpio
            interface = serial.spi(spi=self.bus.spi, gpio=gpio)
        else:
            self.bus = simulator.I2CBus({0x3C: self.chip}, timer=None)
            interface = serial.i2c(port=1) if face == "luma" else serial.i2c(bus=self.bus)
        if library == "lcd":
            options["gpio"] = self.bus.gpio
        else:
            options |= {"width": size[0], "height": size[1]}
        kind = getattr(self(f"{library}.device"), NAMES.get(name, name.lower()))
        self.device = kind(interface, **options)
        self.device.persist = True

    def __call__(self, module: str) -> types.ModuleType:
        return importlib.import_module(f"{self.face}.{module}")

    @property
    def pixels(self) -> Any:
        return self.chip.pixels


@pytest.fixture
def pair(monkeypatch: pytest.MonkeyPatch) -> Callable[..., tuple[Rig, Rig]]:
    """Make a rig of each face, of the same module."""
    monkeypatch.setattr("time.sleep", lambda seconds: None)

    def make(module: Any = MODULES[0], **options: Any) -> tuple[Rig, Rig]:
        made: list[Rig] = []

        def opened(*path: Any) -> Any:
            frame = sys._getframe(1)
            while "self" not in frame.f_locals or not isinstance(frame.f_locals["self"], Rig):
                frame = frame.f_back  # type: ignore[assignment]
            return frame.f_locals["self"].bus

        monkeypatch.setattr(smbus2, "SMBus", opened)
        for face in FACES:
            made.append(Rig(face, module, **options))
        return made[0], made[1]

    return make


def scene(draw: Any, width: int, height: int, step: int, colors: bool = True) -> None:
    """Draw shapes and text in many colors."""
    if not colors:
        draw.ellipse((2 + step, 2, width - 9, height - 3), outline="white")
        draw.text((4, 1), f"{step} {'luma'}", fill="white")
        return
    draw.rectangle((0, 0, width - 1, height - 1), outline="white")
    draw.ellipse((2 + step, 2, 20 + step, height - 3), fill="orange", outline="blue")
    draw.line((0, height - 1, width - 1, step), fill="#3c3c3c")
    draw.text((4, 1), f"{step} {'luma'}", fill="red")
    for x in range(0, width, 5):
        draw.point((x, (7 * x + step) % height), fill=f"#{2 * x % 256:02x}{255 - x % 256:02x}5a")


def same(rigs: tuple[Rig, Rig]) -> None:
    assert np.array_equal(rigs[0].pixels, rigs[1].pixels)


# -- Every chip


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("module", MODULES, ids=lambda module: f"{module[0]}-{module[1][0]}x{module[1][1]}")
def test_canvas(pair: Any, module: Any, turns: int) -> None:
    options = [{"mode": mode} for mode in ("RGB", "1")] if module[0] in GRAY else [{}]
    for option in options:
        rigs = pair(module, rotate=turns, **option)
        sheared = turns % 2 and module[0] in TURNED_WRONG
        for step in range(3):
            for rig in rigs:
                device = rig.device
                with rig("core.render").canvas(device, dither=step == 2) as draw:
                    scene(draw, device.width, device.height, step, module[0] not in WHITE_ONLY)
            if sheared:
                other = dummy(*module[1], rotate=turns, mode="1")
                with canvas(other, dither=step == 2) as draw:
                    scene(draw, other.width, other.height, step)
                way = -1 if module[0] == "UC1701" else 1
                assert np.array_equal(rigs[1].pixels[::way, ::way], np.asarray(other.image))
            else:
                same(rigs)
            assert rigs[1].pixels.any()
        assert rigs[1].bus.bytes < rigs[0].bus.bytes
        devices = [rig.device for rig in rigs]
        for name in ("width", "height", "size", "bounding_box", "rotate", "mode"):
            assert getattr(devices[0], name) == getattr(devices[1], name), name
        for rig in rigs:
            rig.device.contrast(0x21)
        assert rigs[0].chip.contrast == rigs[1].chip.contrast
        shown = rigs[1].pixels.copy()
        for rig in rigs:
            rig.device.hide()
        same(rigs)
        for rig in rigs:
            rig.device.show()
        assert np.array_equal(rigs[1].pixels, shown)
        for rig in rigs:
            rig.device.clear()
        assert not rigs[1].pixels.any()
        assert rigs[1].chip.violations == []


@pytest.mark.parametrize("orientation", [0, 90, -90, 180])
@pytest.mark.parametrize("reverse", [False, True])
def test_matrices_are_mounted_as_luma_has_them(pair: Any, orientation: int, reverse: bool) -> None:
    options = {"block_orientation": orientation, "blocks_arranged_in_reverse_order": reverse}
    rigs = pair(MODULES[-1], **options)
    picture = Image.fromarray(np.random.default_rng(4).integers(0, 2, (8, 32), np.uint8) * 255).convert("1")
    for rig in rigs:
        rig.device.display(picture.copy())  # luma turns the script's own image around
    same(rigs)
    assert rigs[1].pixels.any()


@given(st.binary(min_size=3 * 64, max_size=3 * 64), st.sampled_from(["RGB", "1"]), st.booleans())
def test_colors_become_the_same_grays(colors: bytes, mode: str, dither: bool) -> None:
    """Of luma's own conversion: weights of 1024, cut off to four bits; mode 1 by Pillow."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("time.sleep", lambda seconds: None)
        made = []
        for face in FACES:
            module = ("SSD1325", (128, 64), {}, "oled")
            made.append(Rig(face, module, mode=mode))
        image = Image.new("RGB", (128, 64))
        image.paste(Image.frombytes("RGB", (8, 8), colors), (5, 3))
        for rig in made:
            with rig("core.render").canvas(rig.device, background=image, dither=True):
                pass
        same((made[0], made[1]))


# -- Virtual devices


def test_viewport_hotspot_and_snapshot(pair: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    rigs = pair()
    clock = [100.0]
    monkeypatch.setattr("time.perf_counter", lambda: clock[0])
    monkeypatch.setattr("luma.core.virtual.perf_counter", lambda: clock[0])
    views, counts = [], []
    for rig in rigs:
        drawn = {"hot": 0, "snap": 0}
        counts.append(drawn)

        def ball(draw: Any, width: int, height: int, drawn: Any = drawn) -> None:
            drawn["hot"] += 1
            draw.ellipse((0, 0, width - 1, height - 1), outline="white")

        def number(draw: Any, width: int, height: int, drawn: Any = drawn) -> None:
            drawn["snap"] += 1
            draw.text((0, 0), str(drawn["snap"]), fill="white")

        virtual = rig("core.virtual")
        view = virtual.viewport(rig.device, width=300, height=100)
        with rig("core.render").canvas(view) as draw:
            scene(draw, 300, 100, 5)
        view.spot = virtual.hotspot(20, 20, ball)
        view.add_hotspot(view.spot, (10, 10))
        view.add_hotspot(virtual.snapshot(30, 12, number, interval=2.0), (140, 40))
        views.append(view)
    same(rigs)
    for step in range(30):
        clock[0] += 0.3
        for view in views:
            view.set_position((step * 5, step))
        same(rigs)
        assert counts[0] == counts[1]
    assert counts[1]["snap"] > 2
    for view in views:
        view.set_position((0, 0))
        view.remove_hotspot(view.spot, (10, 10))
        view.refresh()
    same(rigs)
    assert not rigs[1].pixels[10:30, 10:30].any()


@pytest.mark.parametrize("dither", [False, True])
def test_viewport_in_color_on_one_bit(pair: Any, dither: bool) -> None:
    rigs = pair()
    for rig in rigs:
        view = rig("core.virtual").viewport(rig.device, 200, 64, mode="RGB" if dither else None, dither=dither)
        with rig("core.render").canvas(view) as draw:
            scene(draw, 200, 64, 3)
        view.set_position((50, 0))
    same(rigs)


@pytest.mark.parametrize(
    "options",
    [
        {},
        pytest.param({"animate": False, "word_wrap": True}, marks=pytest.mark.thorough),
        {"color": "yellow", "bgcolor": "blue", "line_height": 10, "tabstop": 3},
    ],
    ids=["plain", "wrapped", "colored"],
)
@pytest.mark.parametrize("module", [MODULES[0], MODULES[15], MODULES[17]], ids=["SSD1306", "SSD1322", "SSD1327"])
def test_terminal(pair: Any, module: Any, options: dict[str, Any]) -> None:
    rigs = pair(module)
    terms = [rig("core.virtual").terminal(rig.device, **options) for rig in rigs]
    assert terms[0].size == terms[1].size
    steps: list[Callable[[Any], object]] = [
        lambda term: term.println("Terminal mode demo"),
        lambda term: term.println(),
        lambda term: term.puts("a\tbc\td"),
        lambda term: term.puts("over\rOVER\b\bxy\n"),
        lambda term: term.println("\033[31mred \033[42mon green\033[0m and \033[7mreversed\033[0m; \033[1;34mblue"),
        lambda term: term.println("a long line that is wrapped by the terminal at its edge, again and again"),
        lambda term: term.reverse_colors(),
        lambda term: [term.println(f"line {number}") for number in range(12)],
        lambda term: term.backspace(),
        lambda term: term.flush(),
        lambda term: term.reset(),
        lambda term: term.clear(),
    ]
    for step in steps:
        for term in terms:
            step(term)
        same(rigs)


def test_history(pair: Any) -> None:
    rigs = pair()
    stacks = [rig("core.virtual").history(rig.device) for rig in rigs]
    for step in range(4):
        for rig, stack in zip(rigs, stacks, strict=True):
            with rig("core.render").canvas(stack) as draw:
                scene(draw, 128, 64, step)
            if step < 3:
                stack.savepoint()
    assert [len(stack) for stack in stacks] == [3, 3]
    for drop in (0, 1):
        for stack in stacks:
            stack.restore(drop)
        same(rigs)
    assert [len(stack) for stack in stacks] == [0, 0]


def test_sevensegment(pair: Any) -> None:
    rigs = pair(("MAX7219", (8, 8), MODULES[-1][2], "led_matrix"))
    digits = [rig("core.virtual").sevensegment(rig.device) for rig in rigs]
    for text in ("HELLO", "3.14159", "12.30.45.", "a€b", ""):
        for each in digits:
            each.text = text
        same(rigs)
    for each in digits:
        each.text = "1234 567"
        each.text[4] = "-"
        each.text[0:2] = "98"
    same(rigs)
    assert str(digits[1].text) == "9834-567"
    with pytest.raises(OverflowError, match="must fit 8 digits"):
        digits[1].text = "123456789"


@given(st.text("12.,a!?€ ", max_size=8), st.sampled_from(["_", None]))
def test_digits_have_luma_s_segments(text: str, notfound: str | None) -> None:
    from luma.led_matrix import segment_mapper as theirs

    assert list(segment_mapper.regular(text, notfound)) == list(theirs.regular(text, notfound))
    if notfound is not None:
        assert list(segment_mapper.dot_muncher(text, notfound)) == list(theirs.dot_muncher(text, notfound))
    assert theirs._DIGITS == segment_mapper.DIGITS


# -- Sprites, frame rate, compositions, old fonts


@pytest.fixture
def sheet(tmp_path: Path) -> Path:
    image = Image.new("RGB", (64, 36))
    ImageDraw.Draw(image).text((2, 2), "sprite sheet", fill="white")
    image.save(tmp_path / "sheet.png")
    return tmp_path / "sheet.png"


def test_spritesheet(sheet: Path) -> None:
    from luma.core.sprite_system import spritesheet as theirs

    data = {
        "image": str(sheet),
        "frames": {"width": 15, "height": 17, "regX": 2, "regY": 1},
        "animations": {
            "run": {"frames": [0, 3, 2, 7], "speed": 0.4, "next": "turn"},
            "turn": {"frames": [1, "blink", 6], "next": "run"},
            "blink": {"frames": range(4, 6), "speed": 0.5},
            "end": {"frames": [7, 0]},
        },
    }
    ours = sprite_system.spritesheet(**data)
    wanted = theirs(**data)
    assert len(ours) == len(wanted) == 8
    for name, length in (("run", 60), ("end", 9)):
        pictures = [[image.tobytes() for image in islice(s.animate(name), length)] for s in (ours, wanted)]
        assert pictures[0] == pictures[1]
        assert len(pictures[0]) == (60 if name == "run" else 2)
    assert ours.frames.size == (15, 17)
    with pytest.raises(AttributeError, match="jump"):
        next(ours.animate("jump"))
    with pytest.raises(IndexError, match="0 to 7, not 8"):
        ours[8]
    with pytest.raises(TypeError, match="numeric"):
        ours["run"]  # type: ignore[index]
    with pytest.raises(ValueError, match="fills 64x36, not 15x17"):
        sprite_system.spritesheet(str(sheet), {"width": 15, "height": 17}, {})


@pytest.mark.parametrize("fps", [16.67, 100, 0])
def test_framerate_regulator(fps: float, monkeypatch: pytest.MonkeyPatch) -> None:
    import luma.core.sprite_system as theirs

    logs = []
    for module, clock_name in ((theirs, "luma.core.sprite_system."), (sprite_system, "time.")):
        now, pauses = [5.0], []

        def sleep(seconds: float, now: Any = now, pauses: Any = pauses) -> None:
            pauses.append(round(seconds, 9))
            now[0] += seconds

        monkeypatch.setattr(f"{clock_name}perf_counter", lambda now=now: now[0])
        monkeypatch.setattr(f"{clock_name}sleep", sleep)
        beat = module.framerate_regulator(fps)
        for work in (0.001, 0.02, 0.5, 0.003, 0.0):
            with beat:
                now[0] += work
        logs.append((pauses, round(beat.effective_FPS(), 6), round(beat.average_transit_time(), 6), beat.called))
    assert logs[0] == logs[1]
    assert logs[1][3] == 5


def test_image_composition(pair: Any) -> None:
    rigs = pair()
    image = Image.new("RGB", (200, 80), "black")
    scene(ImageDraw.Draw(image), 200, 80, 7)
    for rig in rigs:
        module = rig("core.image_composition")
        made = module.ImageComposition(rig.device)
        first = module.ComposableImage(image.convert("1"), position=(3, 4), offset=(10, 2))
        second = module.ComposableImage(Image.new("1", (10, 10), 1), position=(100, 20))
        made.add_image(first)
        made.add_image(second)
        first.offset = (40, 3)
        made.refresh()
        rig.device.display(made())
        assert (first.width, first.height) == (200, 80)
    same(rigs)
    assert rigs[1].pixels.any()
    for rig in rigs:
        made.remove_image(second) if rig is rigs[1] else None
    made.refresh()
    assert not np.asarray(made())[20, 105:108].any()


def test_legacy_text_and_messages(pair: Any) -> None:
    rigs = pair(MODULES[-1])
    for rig in rigs:
        legacy, font = rig("core.legacy"), rig("core.legacy.font")
        with rig("core.render").canvas(rig.device) as draw:
            legacy.text(draw, (1, 0), "Hi!", fill="white", font=font.proportional(font.TINY_FONT))
        rig.sizes = [legacy.textsize("A b"), legacy.textsize("A b", font.tolerant(font.proportional(font.LCD_FONT)))]
    same(rigs)
    assert rigs[0].sizes == rigs[1].sizes
    for rig in rigs:
        legacy, font = rig("core.legacy"), rig("core.legacy.font")
        rig.shown = []
        show = rig.device.display
        rig.device.display = lambda image, show=show, rig=rig: (show(image), rig.shown.append(rig.pixels.tobytes()))
        legacy.show_message(rig.device, "Hello", fill="white", font=font.proportional(font.CP437_FONT), scroll_delay=0)
    assert rigs[0].shown == rigs[1].shown
    assert len(rigs[1].shown) > 40


def test_legacy_fonts_are_our_own_without_luma(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "luma.core.legacy.font", None)
    legacy_font._named.cache_clear()
    try:
        font = legacy_font.SINCLAIR_FONT
        assert font[ord("H")] == [0x7F, 0x08, 0x08, 0x08, 0x7F, 0x00]
        assert legacy_font.proportional(font)[ord("i")] == [0x44, 0x7D, 0x40, 0]
        assert legacy_font.tolerant(font)[5000] == font[ord("_")]
        with pytest.raises(IndexError, match="no character 5000: see tolerant"):
            legacy_font.proportional(font)[5000]
    finally:
        legacy_font._named.cache_clear()
    with pytest.raises(AttributeError, match="fonts are ATARI_FONT"):
        _ = legacy_font.COMIC_FONT


# -- Devices and the command line


def test_command_line(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    chip = simulator.SH1106(128, 64)
    monkeypatch.setattr(smbus2, "SMBus", lambda path: simulator.I2CBus({0x3D: chip}))
    options = tmp_path / "panel.conf"
    options.write_text("# a panel\n--display=sh1106\n\n--i2c-address=0x3D\n--rotate=1\n")
    parser = cmdline.create_parser(description="test")
    args = parser.parse_args([*cmdline.load_config(options), "--rotate=2"])
    device = cmdline.create_device(args)
    assert isinstance(device, sh1106)
    assert (device.size, device.rotate, device.mode) == ((128, 64), 2, "1")
    device.display(Image.new("1", (128, 64), 1))
    assert chip.pixels.all()
    assert cmdline.get_library_for_display_type("max7219") == "led_matrix"
    assert cmdline.get_library_for_display_type("vga") is None
    assert "ssd1306" in cmdline.get_display_types()["oled"]
    args.display = "vga"
    with pytest.raises(ValueError, match=r"display must be one of .*ssd1306"):
        cmdline.create_device(args)


def test_command_line_on_spi(monkeypatch: pytest.MonkeyPatch) -> None:
    spidev = pytest.importorskip("spidev")
    chips = {"ssd1322": simulator.SSD1322(256, 64), "pcd8544": simulator.PCD8544(), "max7219": simulator.MAX7219(8, 8)}
    for name, chip in chips.items():
        lines: dict[str, Any] = {"dc": None, "reset": None} if name == "max7219" else {}
        bus = simulator.SPIBus(chip, timer=None, **lines)
        monkeypatch.setattr(spidev, "SpiDev", lambda bus=bus: bus.spi)
        pins = types.ModuleType("pins")
        vars(pins).update(BCM=11, OUT=0, setmode=bus.gpio.setmode, setup=bus.gpio.setup, output=bus.gpio.output)
        monkeypatch.setitem(sys.modules, "pins", pins)
        size = ["--width", "256"] if name == "ssd1322" else ["--width", "8", "--height", "8"]
        parsed = cmdline.create_parser("x").parse_args(["-d", name, "-i", "spi", "--gpio", "pins", *size])
        device = cmdline.create_device(parsed)
        assert device.mode == ("RGB" if name == "ssd1322" else "1")
        device.display(Image.new(device.mode, device.size, "white"))
        assert (chip.pixels == chip.max_level).all()
        if name == "pcd8544":
            assert bus.gpio.input(18) == 0  # active low unless --backlight-active=high
            device.cleanup()
            assert bus.gpio.input(18) == 1


def bench() -> tuple[Any, Any]:
    chip = simulator.SSD1306(128, 64)
    return chip, ssd1306(i2c(bus=simulator.I2CBus({0x3C: chip})))


def test_cleanup_leaves_black_unless_it_is_to_persist() -> None:
    for persist in (False, True):
        chip, device = bench()
        device.persist = persist
        assert device.persist is persist
        device.display(Image.new("1", (128, 64), 1))
        device.cleanup()
        assert chip.pixels.any() == persist
        with pytest.raises(error.Error, match="closed"):
            device.display(Image.new("1", (128, 64)))


def test_commands_and_data_reach_the_chip() -> None:
    chip, device = bench()
    device.command(0x81, 0x12)
    assert chip.contrast == 0x12
    device.command(0xB0, 0x00, 0x10)
    device.data([0xFF] * 4)
    device.display(Image.new("1", (128, 64)))
    assert not chip.pixels.any()


def half_a_picture(device: Any) -> None:
    with canvas(device) as draw:
        draw.rectangle((0, 0, 9, 9), fill="white")
        raise ValueError("oops")


def test_a_canvas_that_raises_shows_nothing() -> None:
    chip, device = bench()
    with pytest.raises(ValueError, match="oops"):
        half_a_picture(device)
    assert not chip.pixels.any()


def test_interfaces_by_others() -> None:
    """Such as luma.core's own, for FTDI adapters."""

    class Interface:
        def __init__(self) -> None:
            self.closed = False

        def command(self, *cmd: int) -> None:
            bus.i2c_rdwr(smbus2.i2c_msg.write(0x3C, [0, *cmd]))

        def data(self, data: list[int]) -> None:
            bus.i2c_rdwr(smbus2.i2c_msg.write(0x3C, [0x40, *data]))

        def cleanup(self) -> None:
            self.closed = True

    chip = simulator.SSD1306(128, 64)
    bus = simulator.I2CBus({0x3C: chip})
    interface = Interface()
    device = ssd1306(interface)
    with canvas(device) as draw:
        scene(draw, 128, 64, 4)
    plain, other = bench()
    with canvas(other) as draw:
        scene(draw, 128, 64, 4)
    assert np.array_equal(chip.pixels, plain.pixels)
    device.cleanup()
    assert interface.closed


def test_full_frame_sends_pictures_whole() -> None:
    from paneldraw.compat.luma.core.framebuffer import diff_to_previous, full_frame

    sent = []
    for way in (diff_to_previous(), full_frame()):
        bus = simulator.I2CBus({0x3C: simulator.SSD1306(128, 64)})
        device = ssd1306(i2c(bus=bus), framebuffer=way)
        device.clear()
        before = bus.bytes
        with canvas(device) as draw:
            draw.point((5, 5), fill="white")
        sent.append(bus.bytes - before)
    assert sent[0] < 20
    assert sent[1] > 1024


def test_sh1106_offset() -> None:
    chip = simulator.SH1106(128, 64, column_offset=0)
    device = sh1106(i2c(bus=simulator.I2CBus({0x3C: chip})), page_address_offset=0)
    device.display(Image.new("1", (128, 64), 1))
    assert chip.pixels.all()


def test_dummy_keeps_what_it_shows() -> None:
    device = dummy(width=20, height=10, rotate=1)
    with canvas(device) as draw:
        draw.point((0, 0), fill="red")
    assert device.size == (10, 20)
    assert device.image is not None
    assert device.image.size == (20, 10)
    assert device.image.getpixel((19, 0)) == (255, 0, 0)
    device.show()
    device.hide()
    with pytest.raises(ValueError, match="0 to 255"):
        device.contrast(256)


# -- What is wrong


@pytest.mark.parametrize(
    ("wrong", "kind", "says"),
    [
        (lambda: i2c(address=0x99), error.DeviceAddressError, "0x08 to 0x77"),
        (lambda: i2c(address="panel"), error.DeviceAddressError, "such as 0x3C, not 'panel'"),
        (lambda: ssd1306(i2c(bus=simulator.I2CBus({}))), error.DeviceNotFoundError, "nobody answers at 0x3C"),
        (lambda: ssd1306(i2c(port=99)), error.DeviceNotFoundError, "i2c-99"),
        (lambda: ssd1306(noop(), width=100), error.DeviceDisplayModeError, "100x64"),
        (lambda: ssd1306(noop(), rotate=90), error.DeviceDisplayModeError, "0, 1, 2 or 3 quarter turns, not 90"),
        (lambda: ssd1306(noop(), mode="RGB"), error.DeviceDisplayModeError, "mode of the SSD1306 must be 1, not 'RGB'"),
        (lambda: ssd1322(noop(), mode="L"), error.DeviceDisplayModeError, "must be RGB or 1, not 'L'"),
        (lambda: max7219(noop(), block_orientation=45), error.DeviceDisplayModeError, "0, 90, -90 or 180, not 45"),
        (lambda: spi(spi_mode=3), ValueError, "spi_mode must be 0, not 3"),
        (lambda: ssd1306(3), TypeError, "serial_interface must be"),
        (lambda: ssd1306(noop(), colour=1), TypeError, "colour"),
        (lambda: canvas(dummy(), Image.new("RGB", (3, 3))), ValueError, r"size \(128, 64\), not \(3, 3\)"),
        (lambda: dummy(mode="CMYK"), error.DeviceDisplayModeError, "one of 1, RGB, RGBA, not 'CMYK'"),
        (lambda: dummy().display(Image.new("1", (128, 64))), ValueError, r"128x64 of mode 1: image.convert\('RGB'\)"),
        (lambda: dummy().display("x"), ValueError, "image must be 128x64 of mode RGB, not 'x'"),
        (lambda: virtual.viewport(dummy(), 200, 64).set_position((100, 0)), ValueError, r"\(0, 0\) to \(72, 0\)"),
        (lambda: virtual.viewport(dummy(), 200, 64).add_hotspot(virtual.hotspot(9, 9), (195, 0)), ValueError, "inside"),
        (lambda: virtual.snapshot(9, 9, interval=0), ValueError, "interval must be seconds above 0, not 0"),
        (lambda: virtual.history(dummy()).restore(), IndexError, "so many savepoints"),
    ],
)
def test_errors_are_clear(wrong: Callable[[], object], kind: type[Exception], says: str) -> None:
    with pytest.raises(kind, match=says):
        wrong()


def test_lcd_without_lines_says_what_to_do(monkeypatch: pytest.MonkeyPatch) -> None:
    bus = simulator.SPIBus(simulator.PCD8544(), timer=None)
    lit: list[bool] = []
    device = pcd8544(spi(spi=bus.spi, gpio=bus.gpio), backlight=lit.append)
    device.cleanup()
    assert lit == [True, False]


# -- Scripts by others


def test_only_imports_change() -> None:
    source = "import luma.core.render\nfrom luma.core import cmdline\nx = luma.core.render.canvas  # luma\n"
    assert moved(source) == (
        "import paneldraw.compat.luma.core.render; from paneldraw.compat import luma\n"
        "from paneldraw.compat.luma.core import cmdline\nx = luma.core.render.canvas  # luma\n"
    )


EXAMPLES = "https://github.com/rm-hull/luma.examples"


@pytest.fixture(scope="module")
def examples(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """luma.examples, of the folder that LUMA_EXAMPLES names or from their repository, and with changed imports."""
    folder = tmp_path_factory.mktemp("luma")
    checkout = Path(os.environ.get("LUMA_EXAMPLES") or folder / "theirs")
    if not checkout.exists():
        got = subprocess.run(["git", "clone", "-q", "--depth=1", EXAMPLES, str(checkout)], capture_output=True)
        if got.returncode:
            pytest.skip(f"needs LUMA_EXAMPLES=folder, or the network for {EXAMPLES}")
    return checkout / "examples", moved_folder(checkout / "examples", folder / "ours")


@pytest.mark.thorough
@pytest.mark.timeout(3600)
def test_luma_examples(examples: tuple[Path, Path]) -> None:
    theirs, ours = examples
    passed = []
    for script in sorted(file.stem for file in theirs.glob("*.py") if file.stem != "demo_opts"):
        display = "max7219" if script in ("dotmatrixtool", "sevensegment_demo") else "ssd1306"
        wanted, shown = run(theirs, script, FACES[0], display), run(ours, script, FACES[1], display)
        if wanted.pictures and shown.pictures == wanted.pictures and shown.wire_bytes < wanted.wire_bytes:
            passed.append(script)
    assert len(passed) >= 38, passed
