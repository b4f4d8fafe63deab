"""The SSD1322 on a wire that tells command and data apart by a line: windows of four pixels a column."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image
from windows import Ram

from paneldraw import Panel, open_panel
from paneldraw.controllers import SSD1322
from paneldraw.transports import COMMAND, DATA, Cost


class Wire:
    """A transport to a chip's RAM; a message costs a byte, as a change of D/C may. It keeps commands with arguments."""

    cost = Cost(1, 1)

    def __init__(self, controller):
        self.ram = Ram(controller)
        self.commands = []
        self.bytes = self.messages = 0

    def _take(self, kind, payload):
        self.ram.take(kind, bytes(payload))
        if kind == COMMAND:
            self.commands += [bytes((byte,)) for byte in bytes(payload)]
        elif self.commands[-1] != b"\x5c":
            self.commands[-1] += bytes(payload)
        self.bytes += 1 + len(payload)
        self.messages += 1
        return 1 + len(payload)

    def command(self, payload):
        return self._take(COMMAND, payload)

    def data(self, payload):
        return self._take(DATA, payload)

    def batch(self, plan):
        return sum(self._take(kind, payload) for kind, payload in plan)

    def reset(self):
        return False

    def close(self):
        pass

    @property
    def pixels(self):
        """What is in the middle of the RAM."""
        visible = self.ram.bytes[:64, 56:184].astype(np.uint8)
        return np.stack((visible >> 4, visible & 15), axis=2).reshape(64, 256)


def greys(seed=1):
    return np.random.default_rng(seed).integers(0, 16, (64, 256), np.uint8)


def test_pictures_arrive_and_are_counted():
    wire = Wire(SSD1322())
    panel = Panel(SSD1322(), wire)
    picture = greys()
    started = wire.bytes, wire.messages
    for _ in range(6):
        panel.show(picture)
        np.testing.assert_array_equal(wire.pixels, picture)
        picture[5:9, 40:60] ^= 3
        picture[60, 250] ^= 1
    assert panel.stats.wire_bytes == wire.bytes - started[0]
    assert panel.stats.messages == wire.messages - started[1]


def test_one_pixel_is_two_windows_commands_and_one_column():
    wire = Wire(SSD1322())
    panel = Panel(SSD1322(), wire)
    picture = greys()
    for y, x in ((30, 100), (10, 50)):
        panel.show(picture)
        picture[y, x] ^= 1
        del wire.commands[:]
        report = panel.show(picture)
    assert wire.commands == [b"\x15\x28\x28", b"\x75\x0a\x0a", b"\x5c"]
    assert report[:3] == ((1 + 1) + (1 + 2) + (1 + 1) + (1 + 2) + (1 + 1) + (1 + 2), 6, 1)


def test_arguments_of_every_command_go_as_data():
    wire = Wire(SSD1322())
    panel = Panel(SSD1322(), wire)
    assert wire.commands == list(SSD1322().init)
    panel.contrast(9)
    panel.invert()
    assert wire.commands[-2:] == [b"\xc1\x09", b"\xa7"]


@pytest.mark.filterwarnings("ignore:Image.Image.getdata is deprecated")
def test_luma_puts_the_same_bytes_there():
    from luma.oled.device import ssd1322

    class Serial:
        """luma.core's interface of a bus, over the wire."""

        def __init__(self, wire):
            self.wire = wire

        def command(self, *command):
            self.wire.command(bytes(command))

        def data(self, data):
            self.wire.data(bytes(data))

    theirs, ours = Wire(SSD1322()), Wire(SSD1322())
    device = ssd1322(Serial(theirs))
    device.persist = True
    panel = Panel(SSD1322(), ours)
    picture = greys(2)
    for _ in range(2):
        device.display(Image.fromarray(picture * 17).convert("RGB"))
        panel.show(picture)
        np.testing.assert_array_equal(ours.pixels, picture)
        np.testing.assert_array_equal(theirs.pixels, picture)
        picture[20:30, 33:77] = 7


@pytest.mark.parametrize(
    ("mirror", "remap"), [((False, False), 0x14), ((True, True), 0x06), ((True, False), 0x16), ((False, True), 0x04)]
)
def test_mirrored_glass(mirror, remap):
    controller = SSD1322(mirror_x=mirror[0], mirror_y=mirror[1])
    assert bytes((0xA0, remap, 0x11)) in controller.init
    assert controller.window.down == bytes((0xA0, remap | 1, 0x11))


def test_what_cannot_be():
    with pytest.raises(ValueError, match="64x48 or 64x32, not 200x64; for another one give column_offset= too"):
        SSD1322(200, 64)
    with pytest.raises(ValueError, match="multiples of 4"):
        SSD1322(column_offset=98)
    with pytest.raises(ValueError, match=r"it is on SPI, such as spi://0.0\?chip=ssd1322"):
        open_panel("i2c://1/0x3c?chip=ssd1322")
