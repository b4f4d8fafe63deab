"""MicroPython's framebuf, against what MicroPython itself draws."""

from __future__ import annotations

import importlib
import re
import sys
from array import array

import numpy as np
import pytest
import real_micropython as real

CALLS = ("blit", "ellipse", "fill", "fill_rect", "hline", "line", "pixel", "poly", "rect", "scroll", "text", "vline")


@pytest.fixture
def framebuf(package):
    """The module, compiled and once more as plain Python."""
    return importlib.import_module(f"{package.__name__}.compat.framebuf")


def picture(fb, width, height):
    """The pixels, a character each."""
    return ["".join(".#"[fb.pixel(x, y) > 0] for x in range(width)) for y in range(height)]


# -- Pixels


def test_the_buffers_of_the_table_are_micropythons(framebuf):
    compared = 0
    for script, buffer in real.table():
        assert real.drawn(framebuf, script).hex() == buffer.hex(), script
        compared += 1
    assert compared == 400


def test_the_table_has_every_call_in_every_format():
    found = {
        (script.arguments.split(", ")[2], call)
        for script, _ in real.table()
        for call in re.findall(r"(?:^|; )(\w+)\(", script.calls)
    }
    assert found == {(name, call) for name in real.FORMATS for call in CALLS if call != "text"}


@pytest.fixture(scope="module")
def micropython(tmp_path_factory):
    try:
        return real.MicroPython(tmp_path_factory.mktemp("micropython"))
    except OSError as error:
        pytest.skip(str(error))


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(2, 8))
def test_scripts_at_random_draw_what_micropython_draws(framebuf, micropython, monkeypatch, seed):
    """Texts too, in its own letters."""
    monkeypatch.setattr(framebuf, "font", micropython.letters())
    asked = real.scripts(seed, 1000, text=True)
    for script, buffer in zip(asked, micropython.drawn(asked), strict=True):
        assert real.drawn(framebuf, script).hex() == buffer.hex(), script


WRONG = (
    *("FrameBuffer(bytearray(8), 8, 8)", "FrameBuffer(bytearray(8), 8, 8, 7)", "FrameBuffer(bytearray(8), 8, 8, -1)"),
    *(
        "FrameBuffer(bytearray(7), 8, 8, 0)",
        "FrameBuffer(bytearray(8), 0, 8, 0)",
        "FrameBuffer(bytearray(8), 8, -1, 0)",
    ),
    *("FrameBuffer(bytearray(8), 8, 8, 0, 7)", "FrameBuffer(bytearray(99), 9, 1, 3, 65536)"),
    *("FrameBuffer(b'12345678', 8, 8, 0)", "FrameBuffer([0] * 8, 8, 8, 0)", "FrameBuffer(bytearray(8), 8.0, 8, 0)"),
    *("FrameBuffer(bytearray(31), 8, 2, 1)", "FrameBuffer(bytearray(15), 5, 8, 2, 8)", "FrameBuffer1(bytearray(1))"),
    *("fb.pixel(1.5, 2)", "fb.pixel('1', 2)", "fb.fill()", "fb.fill(None)", "fb.line(1, 2, 3, 4)", "fb.scroll(1)"),
    *("fb.poly(0, 0, [1, 2, 3, 4], 1)", "fb.poly(0, 0, array('f', [1, 2, 3, 4]), 1)", "fb.text(5, 0, 0)"),
    *("fb.blit((b'1', 8, 1), 0, 0)", "fb.blit((b'1', 8, 2, 3), 0, 0)", "fb.blit(b'1', 0, 0)", "fb.blit(5, 0, 0)"),
    *("fb.rect(0, 0, 1, 1, c=1)", "fb.hline(x=0, y=0, w=1, c=1)", "fb.ellipse(0, 0, 1, 1)", "fb.fill(1 << 40)"),
)
#: MicroPython's numbers end at 31 bits; ours take the lower 32 of a color.
LENIENT = ("fb.fill(1 << 40)",)


def error_of(expression, names):
    try:
        eval(expression, names)
    except Exception as error:
        return type(error).__name__
    return "None"


def test_wrong_arguments_are_refused(framebuf):
    names = vars(framebuf) | {"array": array, "fb": framebuf.FrameBuffer(bytearray(8), 8, 8, framebuf.MONO_VLSB)}
    for expression in WRONG:
        expected = "None" if expression in LENIENT else ("TypeError", "ValueError")
        assert error_of(expression, names) in expected, expression


@pytest.mark.thorough
def test_what_is_refused_micropython_refuses_with_the_same_error(framebuf, micropython):
    program = f"""if True:
        import framebuf
        from array import array
        names = {{name: getattr(framebuf, name) for name in dir(framebuf)}}
        names["array"] = array
        names["fb"] = framebuf.FrameBuffer(bytearray(8), 8, 8, framebuf.MONO_VLSB)
        for expression in {WRONG!r}:
            try:
                eval(expression, names)
                print("None")
            except Exception as error:
                print(type(error).__name__)
    """
    names = vars(framebuf) | {"array": array, "fb": framebuf.FrameBuffer(bytearray(8), 8, 8, framebuf.MONO_VLSB)}
    theirs = dict(zip(WRONG, micropython.run(program).split(), strict=True))
    ours = {expression: error_of(expression, names) for expression in WRONG}
    assert {one: (ours[one], theirs[one]) for one in WRONG if ours[one] != theirs[one] and one not in LENIENT} == {}


@pytest.mark.thorough
def test_the_names_are_micropythons(framebuf, micropython):
    program = "import framebuf\nprint(*dir(framebuf), *dir(framebuf.FrameBuffer), framebuf.GS8, framebuf.MONO_HMSB)"
    *names, gs8, mono_hmsb = micropython.run(program).split()
    public = {name for name in names if not name.startswith("_")}
    assert public == {*framebuf.__all__, *CALLS}
    assert [int(gs8), int(mono_hmsb)] == [framebuf.GS8, framebuf.MONO_HMSB]


def test_the_calls_are_micropythons(framebuf):
    assert {name for name in dir(framebuf.FrameBuffer) if not name.startswith("_")} == set(CALLS)


def test_a_tie_is_broken_toward_the_second_end(framebuf):
    fb = framebuf.FrameBuffer(bytearray(8), 8, 8, framebuf.MONO_HLSB)
    fb.line(0, 0, 2, 1, 1)
    fb.line(2, 4, 0, 3, 1)
    assert picture(fb, 3, 5) == ["#..", ".##", "...", "##.", "..#"]


def test_a_size_that_is_not_positive_draws_nothing(framebuf):
    for form in (framebuf.MONO_VLSB, framebuf.GS4_HMSB):
        buffer = bytearray(32)
        fb = framebuf.FrameBuffer(buffer, 8, 8, form)
        for size in (0, -3):
            fb.hline(4, 4, size, 1)
            fb.vline(4, 4, size, 1)
            fb.rect(4, 4, size, 3, 1, True)
            fb.fill_rect(4, 4, 3, size, 1)
        assert buffer == bytes(32)


# -- Memory


@pytest.mark.parametrize("seed", range(3))
def test_nothing_outside_of_the_buffer_is_touched(framebuf, seed):
    for script in real.scripts(seed, 200, text=True):
        around = bytearray(b"\xa5") * (script.size + 32)
        names = vars(framebuf) | {"array": array, "buffer": memoryview(around)[16:-16]}
        names["fb"] = eval(f"FrameBuffer(buffer, {script.arguments})", names)
        for call in script.calls.split("; "):
            eval(f"fb.{call}", names)
        assert around[:16] + around[-16:] == b"\xa5" * 32, script


@pytest.mark.parametrize(
    "memory",
    [
        lambda: bytearray(16),
        lambda: array("H", bytes(16)),
        lambda: np.zeros((2, 8), np.uint8),
        lambda: memoryview(bytearray(16)),
    ],
    ids=["bytearray", "array", "numpy", "memoryview"],
)
def test_it_draws_in_the_callers_memory(framebuf, memory):
    buffer = memory()
    fb = framebuf.FrameBuffer(buffer, 8, 16, framebuf.MONO_VLSB)
    fb.pixel(3, 9, 1)
    assert bytes(buffer) == bytes(11) + b"\2" + bytes(4)


def test_it_lends_the_same_memory(framebuf):
    if sys.version_info < (3, 12) and framebuf.__file__.endswith(".py"):
        pytest.skip("a class in Python cannot lend memory before Python 3.12")
    buffer = bytearray(8)
    fb = framebuf.FrameBuffer(buffer, 8, 8, framebuf.MONO_HLSB)
    memoryview(fb)[2] = 0x81
    assert buffer[2] == 0x81
    assert picture(fb, 8, 3)[2] == "#......#"
    assert b"".join((b"\x40", fb)) == b"\x40" + buffer
    with pytest.raises(BufferError):
        buffer.append(0)
    other = framebuf.FrameBuffer(fb, 8, 8, framebuf.MONO_HLSB)
    other.fill(0)
    assert buffer == bytes(8)


def test_a_picture_may_be_smaller_than_its_buffer_and_its_rows(framebuf):
    buffer = bytearray(8 * 3)
    fb = framebuf.FrameBuffer(buffer, 10, 4, framebuf.MONO_HLSB, 20)
    fb.fill(1)
    assert buffer[:12].hex() == "ffc000" * 4
    assert buffer[12:] == bytes(12)


def test_the_low_byte_of_rgb565_comes_first(framebuf):
    buffer = bytearray(8)
    fb = framebuf.FrameBuffer(buffer, 2, 2, framebuf.RGB565)
    fb.pixel(1, 0, 0xF81F)
    fb.hline(0, 1, 2, 0x1234)
    assert buffer.hex() == "00001ff834123412"
    assert fb.pixel(1, 0) == 0xF81F


def test_framebuffer1_is_mono_vlsb(framebuf):
    buffer = bytearray(20)
    fb = framebuf.FrameBuffer1(buffer, 8, 16, 12)
    assert isinstance(fb, framebuf.FrameBuffer)
    fb.pixel(0, 15, 1)
    assert buffer[12] == 0x80


# -- Subclasses, numbers, texts


def test_a_subclass_has_attributes_of_its_own(framebuf):
    class Panel(framebuf.FrameBuffer):
        def __init__(self):
            self.width = self.height = self.stride = "mine"
            self.memory = bytearray(8)
            super().__init__(self.memory, 8, 8, framebuf.MONO_VLSB)

        def pixel(self, *arguments):
            return "mine"

    panel = Panel()
    panel.line(0, 0, 7, 7, 1)
    assert panel.memory == bytes(1 << k for k in range(8))
    assert (panel.width, panel.pixel(0, 0)) == ("mine", "mine")
    other = framebuf.FrameBuffer(bytearray(8), 8, 8, framebuf.MONO_HLSB)
    other.blit(panel, 0, 0)
    assert picture(other, 8, 8)[3] == "...#...."


def test_a_subclass_that_never_called_its_parent_says_so(framebuf):
    class Forgetful(framebuf.FrameBuffer):
        def __init__(self):
            pass

    other = framebuf.FrameBuffer(bytearray(8), 8, 8, framebuf.MONO_VLSB)
    for draw in (
        *(lambda fb: fb.fill(0), lambda fb: fb.scroll(1, 1), lambda fb: fb.pixel(0, 0)),
        *(lambda fb: other.blit(fb, 0, 0), lambda fb: fb.blit(other, 0, 0)),
    ):
        with pytest.raises(AttributeError, match="of the Forgetful before it draws"):
            draw(Forgetful())


def test_numpys_whole_numbers_are_numbers(framebuf):
    fb = framebuf.FrameBuffer(bytearray(8), np.int64(8), np.uint8(8), np.int8(framebuf.MONO_VLSB))
    fb.line(*np.array([0, 3, 7, 3], np.int16), np.uint8(1))
    fb.poly(0, 0, np.array([0, 0, 2, 0], np.int32), True)
    assert picture(fb, 8, 4)[3] == "########"
    assert picture(fb, 8, 1) == ["###....."]


def test_far_coordinates_end(framebuf):
    fb = framebuf.FrameBuffer(bytearray(8), 8, 8, framebuf.MONO_HLSB)
    far = 1 << 27
    fb.line(-far, -far, far, far, 1)
    assert picture(fb, 8, 8) == ["." * k + "#" + "." * (7 - k) for k in range(8)]
    fb.fill(0)
    fb.rect(4 - far, 2, far, far, 1)
    assert picture(fb, 8, 4)[1:] == ["........", "####....", "...#...."]
    fb.fill(0)
    fb.poly(0, 0, array("i", [-far, -far, far, -far, far, far, -far, far]), 1, True)
    assert picture(fb, 8, 8) == ["########"] * 8
    for call in (
        lambda: fb.hline(far + 1, 0, 1, 1),
        lambda: fb.ellipse(0, 0, 1 << 19, 1, 1),
        lambda: fb.line(0, 0, 0, 1 << 99, 1),
    ):
        with pytest.raises(OverflowError):
            call()


def test_a_text_is_a_cell_a_byte(framebuf):
    def columns(s, *more):
        buffer = bytearray(64)
        framebuf.FrameBuffer(buffer, 64, 8, framebuf.MONO_VLSB).text(s, *(more or (0, 0)))
        return bytes(buffer)

    a, b, unknown = columns("A")[:8], columns("B")[:8], columns("\x7f")[:8]
    assert columns("AB") == a + b + bytes(48)
    assert columns(b"BA", 3, 0)[3:19] == b + a
    assert columns("é!")[:16] == unknown * 2
    assert columns("A\nB\0B") == a + unknown + b + bytes(40)
    assert columns("A", -2, 0)[:6] == a[2:]
    assert columns("A", 0, 3)[:8] == bytes(column << 3 & 255 for column in a)


def test_every_letter_has_a_cell_of_its_own(framebuf):
    buffer = bytearray(96 * 8)
    framebuf.FrameBuffer(buffer, 96 * 8, 8, framebuf.MONO_VLSB).text("".join(map(chr, range(32, 128))), 0, 0)
    cells = [bytes(buffer[at : at + 8]) for at in range(0, len(buffer), 8)]
    assert len(set(cells)) == 96
    assert [chr(32 + k) for k, cell in enumerate(cells) if not any(cell)] == [" "]


def test_other_letters_can_be_had(framebuf, monkeypatch):
    monkeypatch.setattr(framebuf, "font", bytes(8) + bytes(range(1, 9)) + bytes(94 * 8))
    buffer = bytearray(16)
    framebuf.FrameBuffer(buffer, 16, 8, framebuf.MONO_VLSB).text("A!", 0, 0)
    assert buffer == bytes(8) + bytes(range(1, 9))
    monkeypatch.setattr(framebuf, "font", bytes(767))
    with pytest.raises(ValueError, match="must be 768 bytes, not 767"):
        framebuf.FrameBuffer(buffer, 16, 8, framebuf.MONO_VLSB).text("A!", 0, 0)


# -- Pictures


def test_a_palette_says_what_colors_become(framebuf):
    fb = framebuf.FrameBuffer(bytearray(2 * 4), 2, 2, framebuf.RGB565)
    palette = framebuf.FrameBuffer(bytearray(4), 2, 1, framebuf.RGB565)
    palette.pixel(0, 0, 0x001F)
    palette.pixel(1, 0, 0xF800)
    fb.fill(0x7777)
    fb.blit((b"\x80\x40", 2, 2, framebuf.MONO_HLSB), 0, 0, 0x001F, palette)
    assert [fb.pixel(x, y) for y in (0, 1) for x in (0, 1)] == [0xF800, 0x7777, 0x7777, 0xF800]


def test_a_palette_that_is_too_short_is_read_no_further_than_its_memory(framebuf):
    fb = framebuf.FrameBuffer(bytearray(4), 4, 1, framebuf.GS8)
    palette = (bytes([5, 6, 7]), 2, 1, framebuf.GS8)
    fb.blit((bytes([0, 1, 2, 3]), 4, 1, framebuf.GS8), 0, 0, -1, palette)
    assert [fb.pixel(x, 0) for x in range(4)] == [5, 6, 7, 0]
