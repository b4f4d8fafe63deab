from __future__ import annotations

import inspect

import pytest

from firmware_protocol import HelloReply
from paneldraw import Panel, urls
from paneldraw.controllers import HT16K33, IS31FL3731, MAX7219, SH1106, SSD1306, SSD1327
from paneldraw.errors import ProtocolError
from paneldraw.transports import SerialTransport


@pytest.mark.parametrize(
    ("url", "wanted"),
    [
        ("sim://", {"scheme": "sim"}),
        ("sim://ssd1306", {"scheme": "sim"}),
        ("sim://SSD1306?size=128x32", {"scheme": "sim", "controller": SSD1306(128, 32)}),
        ("i2c://1", {}),
        ("i2c://1/", {}),
        ("i2c://3/0x3d", {"bus": 3, "address": 0x3D}),
        ("i2c://3/61", {"bus": 3, "address": 0x3D}),
        ("i2c://1/0x3d?chip=ssd1327", {"address": 0x3D, "controller": SSD1327()}),
        ("i2c://1/0x3c?chip=sh1106", {"controller": SH1106()}),
        ("sim://ssd1327?size=96x96", {"scheme": "sim", "controller": SSD1327(96, 96)}),
        ("i2c:///dev/i2c-7/0x3d", {"bus": "/dev/i2c-7", "address": 0x3D}),
        ("i2c:///dev/i2c-7", {"bus": "/dev/i2c-7"}),
        ("i2c://1/3d", {"address": 0x3D}),
        ("i2c://1:0x3d", {"address": 0x3D}),
        (
            "i2c://1?size=100x50&column_offset=0x0e&com_pins=0x12&first_com=7&max_message=32&updates=plain&contrast=9",
            {
                "controller": SSD1306(100, 50, column_offset=14, com_pins=0x12, first_com=7),
                "module": {"column_offset": 14, "com_pins": 0x12, "first_com": 7},
                "transport": {"max_message": 32},
                "panel": {"updates": "plain", "contrast": 9},
            },
        ),
        (
            "sim://ssd1306?mirror_x=yes&mirror_y=0&charge_pump=false&internal_reference=1",
            {
                "scheme": "sim",
                "controller": SSD1306(mirror_x=True, charge_pump=False, internal_reference=True),
                "module": {"mirror_x": True, "mirror_y": False, "charge_pump": False, "internal_reference": True},
            },
        ),
        (
            "spi://0.1?chip=max7219&size=64x16&order=serpentine&block_rotation=90&mirror_blocks=1&first_block=top-left",
            {
                "scheme": "spi",
                "bus": 0,
                "controller": MAX7219(
                    64, 16, order="serpentine", block_rotation=90, mirror_blocks=True, first_block="top-left"
                ),
                "module": {
                    "order": "serpentine",
                    "block_rotation": "90",
                    "mirror_blocks": True,
                    "first_block": "top-left",
                },
                "transport": {"device": 1, "speed": 8_000_000, "dc": None, "reset": None},
            },
        ),
        ("i2c://1?chip=ht16k33", {"address": 0x70, "controller": HT16K33()}),
        ("sim://ht16k33?size=8x8", {"scheme": "sim", "address": 0x70, "controller": HT16K33(8, 8)}),
        ("i2c://1/0x75?chip=is31fl3731&size=11x7", {"address": 0x75, "controller": IS31FL3731(11, 7)}),
        (
            "i2c://1/?chip=ht16k33&board=featherwing",
            {"address": 0x70, "controller": HT16K33(board="featherwing"), "module": {"board": "featherwing"}},
        ),
        (
            "i2c://1/0x3c?chip=ssd1306&size=96x16&rotate=180&on_close=clear",
            {"controller": SSD1306(96, 16), "panel": {"rotate": 180, "on_close": "clear"}},
        ),
    ],
)
def test_what_a_url_asks_for(url, wanted):
    assert urls.parse(url) == urls.PanelURL(**{"scheme": "i2c", "controller": SSD1306(), **wanted})


@pytest.mark.parametrize(
    ("url", "port", "rest"),
    [
        ("serial:///dev/ttyACM0", "/dev/ttyACM0", {}),
        ("serial:///dev/serial/by-id/usb%20a", "/dev/serial/by-id/usb a", {}),
        ("serial://COM3?baudrate=1000000", "COM3", {"baudrate": 1_000_000}),
        ("serial:///dev/ttyS0?rotate=90&on_close=off", "/dev/ttyS0", {"rotate": 90, "on_close": "off"}),
        ("socket://Pi:7000", "socket://Pi:7000", {}),
        ("loop://", "loop://", {}),
        ("serial://rfc2217://pi:2217?ign_set_control&baudrate=115200", "rfc2217://pi:2217?ign_set_control=", None),
    ],
)
def test_what_a_serial_url_asks_for(url, port, rest):
    wanted = urls.parse(url)
    assert wanted.port == port
    if rest is None:
        assert wanted.baudrate == 115_200
    else:
        assert {"baudrate": wanted.baudrate, **wanted.panel} == {"baudrate": None, **rest}


@pytest.mark.parametrize(
    ("url", "controller"),
    [
        ("serial://COM3", SSD1306(128, 32)),
        ("serial://COM3?size=96x16", SSD1306(96, 16)),
        ("serial://COM3?chip=SSD1306", SSD1306(128, 32)),
    ],
)
def test_the_board_says_what_the_url_does_not(url, controller):
    device = HelloReply(0, controller="ssd1306", width=128, height=32)
    assert urls.parse(url).controller(device) == controller


def test_a_board_that_knows_nothing_of_its_panel():
    with pytest.raises(ValueError, match=r"url must say which chip=.*COM3"):
        urls.parse("serial://COM3").controller(HelloReply(0))
    assert urls.parse("serial://COM3?chip=ssd1306").controller(HelloReply(0)) == SSD1306()
    with pytest.raises(ProtocolError, match=r"chip ssd0303 .* add chip= to the URL with one of ssd1306"):
        urls.parse("serial://COM3").controller(HelloReply(0, controller="ssd0303", width=96, height=16))


@pytest.mark.parametrize(
    ("url", "complaint"),
    [
        ("", "i2c://.*sim://"),
        ("ssd1306", "i2c://.*sim://"),
        ("http://1/0x3c", "i2c://.*sim://"),
        ("i2c://", "i2c://1/0x3c"),
        ("i2c://1/0x3c/7", "i2c://1/0x3c"),
        ("i2c://1/x3c", "address must be a whole number, such as 0x3c"),
        ("i2c://1?chip=ssd1307", "chip must be one of ssd1306.*, not 'ssd1307'; did you mean ssd13"),
        ("i2c://1?mirror=1", "not 'mirror'; did you mean mirror_[xy]"),
        ("i2c://1?size=128*64", "size must be like 128x64"),
        ("i2c://1?size=128x65", "1x1 to 128x64"),
        ("i2c://1?size=100x50", "128x64, 128x32.* for another one give column_offset= and com_pins="),
        ("i2c://1?chip=sh1106&internal_reference=1", "internal_reference must not be given for the SH1106"),
        ("i2c://1?mirror_x=left", "mirror_x must be 1 or 0"),
        ("i2c://1?column_offset=9", "column_offset must be 0 to 0, not 9"),
        ("i2c://1?rotate=left", "rotate must be a whole number, such as 180"),
        ("i2c://1?dim_after=soon", "dim_after must be a number, such as 60, not 'soon'"),
        ("i2c://1?colour=1", "no parameters but chip, size, column_offset, .*, rotate, contrast, on_close, updates"),
        ("i2c://1?size=128x64&size=96x16", "each parameter once"),
        ("sim://ssd1306/0x3c", "sim://ssd1306"),
        ("sim://ssd1306?chip=ssd1306", "no parameters but size, column_offset, .*, rotate, contrast"),
        ("sim://ssd1307", "chip must be one of ssd1306"),
        ("serial://", "serial:///dev/ttyACM0"),
        ("serial://COM3?baudrate=fast", "baudrate must be a whole number, such as 115200"),
        ("serial://COM3?chip=ssd1307", "chip must be one of ssd1306"),
        ("serial://COM3?chip=ssd1306&size=3x3", "128x64, 128x32"),
        ("serial://COM3?speed=1", "no parameters but baudrate, chip, size, column_offset, .*, rotate"),
        ("socket://pi:7000?size=1x1&size=2x2", "each parameter once"),
    ],
)
def test_what_a_url_cannot_say(url, complaint):
    with pytest.raises(ValueError, match=complaint):
        urls.parse(url)


def test_what_a_panel_takes_in_fractions_has_them_in_urls():
    hints = inspect.signature(Panel).parameters
    fractions = [name for name, parameter in hints.items() if parameter.annotation in ("float", "float | None")]
    assert {"dim_after", "bus_share"} < set(fractions)
    for name in fractions:
        for text, wanted in (("0.25", 0.25), ("1e3", 1000.0), ("60", 60), ("0x3c", 60)):
            assert urls.parse(f"sim://ssd1306?{name}={text}").panel == {name: wanted}


def test_a_url_is_a_str():
    with pytest.raises(TypeError, match="url must be a str, not int"):
        urls.parse(1)


@pytest.mark.parametrize("bus", ["1", "/dev/i2c-7"])
def test_a_channel_of_a_multiplexer(bus):
    wanted = urls.parse(f"i2c://{bus}/0x70:3/0x3d?size=128x32")
    assert (str(wanted.bus), wanted.address, wanted.transport) == (bus, 0x3D, {"mux": (0x70, 3)})


def test_a_channel_that_is_no_number():
    with pytest.raises(ValueError, match="channel must be a whole number, such as 3, not 'left'"):
        urls.parse("i2c://1/0x70:left/0x3c")


@pytest.mark.parametrize("port", ["spy:///dev/ttyS0?file=/tmp/x", "alt://dev", "hwgrep://0x2341"])
def test_no_other_handler_of_pyserials_is_reached(port, tmp_path):
    with pytest.raises(ValueError, match="port must be a device or one of rfc2217://, socket://, loop://"):
        urls.parse(f"serial://{port}")
    with pytest.raises(ValueError, match="port must be a device or one of rfc2217://, socket://, loop://"):
        SerialTransport(port)
