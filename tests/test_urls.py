from __future__ import annotations

import pytest

from paneldraw import urls
from paneldraw.controllers import SSD1306


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
        ("i2c:///dev/i2c-7/0x3d", {"bus": "/dev/i2c-7", "address": 0x3D}),
        (
            "i2c://1/0x3c?chip=ssd1306&size=96x16&rotate=180&on_close=clear",
            {"controller": SSD1306(96, 16), "rotate": 180, "on_close": "clear"},
        ),
    ],
)
def test_what_a_url_asks_for(url, wanted):
    assert urls.parse(url) == urls.PanelURL(**{"scheme": "i2c", "controller": SSD1306(), **wanted})


@pytest.mark.parametrize(
    ("url", "complaint"),
    [
        ("", "i2c://.*sim://"),
        ("ssd1306", "i2c://.*sim://"),
        ("http://1/0x3c", "i2c://.*sim://"),
        ("i2c://", "i2c://1/0x3c"),
        ("i2c://1/0x3c/7", "i2c://1/0x3c"),
        ("i2c://1/3c", "address must be a whole number"),
        ("i2c://1?chip=ssd1307", "chip must be one of ssd1306"),
        ("i2c://1?size=128*64", "size must be like 128x64"),
        ("i2c://1?size=128x65", "128x64, 128x32"),
        ("i2c://1?rotate=left", "rotate must be a whole number"),
        ("i2c://1?colour=1", "no parameters but chip, size, rotate, on_close"),
        ("i2c://1?size=128x64&size=96x16", "each parameter once"),
        ("sim://ssd1306/0x3c", "sim://ssd1306"),
        ("sim://ssd1306?chip=ssd1306", "no parameters but size, rotate, on_close"),
        ("sim://ssd1307", "chip must be one of ssd1306"),
    ],
)
def test_what_a_url_cannot_say(url, complaint):
    with pytest.raises(ValueError, match=complaint):
        urls.parse(url)


def test_a_url_is_a_str():
    with pytest.raises(TypeError, match="url must be a str, not int"):
        urls.parse(1)
