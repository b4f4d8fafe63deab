"""``paneldraw view``: a program's panels in a terminal or a browser, and a page of a program that runs elsewhere."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest
from running import ENVIRONMENT, UTF_8, assert_one_line_of_advice, picture_of, started

from paneldraw import open_panel, simulator

SCRIPT = """
    import sys
    from paneldraw import open_panel

    with open_panel({url}) as panel, panel.frame() as fb:
        fb.line(0, 0, 127, 63)
    sys.exit({code})
"""


@pytest.fixture
def script(tmp_path):
    def write(url="", code=0):
        path = tmp_path / "script.py"
        path.write_text(textwrap.dedent(SCRIPT.format(url=repr(url) if url else "", code=code)))
        return path

    return write


def line():
    panel = open_panel("sim://ssd1306")
    with panel.frame() as fb:
        fb.line(0, 0, 127, 63)
    return panel.simulated


def drawn(chip):
    return simulator.text(chip.pixels).split("\n")


@pytest.mark.parametrize(
    ("url", "dashes"),
    [
        ("", ()),
        ("sim://ssd1306", ("--",)),
        pytest.param("", ("--",), marks=pytest.mark.thorough),
        pytest.param("sim://ssd1306", (), marks=pytest.mark.thorough),
    ],
)
def test_a_program_is_seen_in_the_terminal_and_its_exit_code_is_its_own(script, url, dashes):
    done = started("view", "--terminal", *dashes, sys.executable, script(url, 7))
    assert done.returncode == 7, done.stderr
    assert picture_of(done.stdout) == drawn(line())


def test_the_panel_may_be_said(script):
    done = started("view", "--terminal", "--panel", "sim://ssd1306?size=128x32", "--", sys.executable, script())
    assert len(picture_of(done.stdout)) == 16
    done = started("view", "--terminal", "--panel", "sim://ssd1307", "--", sys.executable, script())
    assert_one_line_of_advice(done, 1)


def test_what_is_shown_can_be_saved_too(script, tmp_path):
    done = started("view", "--terminal", "--save", tmp_path / "out.gif", "--", sys.executable, script())
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out.gif").read_bytes()[:4] == b"GIF8"


@pytest.mark.parametrize(
    ("arguments", "advice"),
    [
        ((), "COMMAND is missing"),
        (("--",), "COMMAND is missing"),
        (("--look", "bleu", "--", "true"), "did you mean blue"),
        (("--listen", "host:port", "--", "true"), "listen must be like"),
        (("--save", "out.jpg", "--", "true"), "save must end in"),
        (("--", "no-such-program"), "there is no command no-such-program"),
        (("--terminal", "http://127.0.0.1:9/"), "there is no page at http://127.0.0.1:9/"),
    ],
)
def test_what_is_wrong_is_said_in_a_line(run, arguments, advice):
    done = run("view", *arguments)
    assert_one_line_of_advice(done, 1)
    assert advice in done.stderr


BROWSER = """
import asyncio, sys
import aiohttp

async def browse(url):
    async with aiohttp.ClientSession() as client:
        async with client.get(url) as answer:
            assert answer.status == 200
        async with client.ws_connect(url.rstrip("/") + "/frames") as feed:
            await feed.receive()
            picture = await feed.receive_bytes()
            await feed.receive()
    open(sys.argv[2], "wb").write(picture)

asyncio.run(browse(sys.argv[1]))
"""


@pytest.mark.skipif(os.name != "posix", reason="browsers are found otherwise there")
def test_a_script_that_is_over_at_once_is_seen_in_a_browser(script, tmp_path):
    browser, seen = tmp_path / "browser.py", tmp_path / "seen"
    browser.write_text(BROWSER)
    environment = {"DISPLAY": ":0", "BROWSER": f"{sys.executable} {browser} %s {seen} &"}
    done = started("view", "--", sys.executable, script(), **environment)
    assert done.returncode == 0, done.stderr
    assert done.stderr.startswith("paneldraw: watch at http://127.0.0.1:")
    deadline = time.monotonic() + 20
    while not seen.exists() or not seen.read_bytes():
        assert time.monotonic() < deadline
        time.sleep(0.02)
    assert seen.read_bytes()[-1024:] == np.packbits(line().pixels).tobytes()


def test_the_page_of_a_running_program_is_seen_in_the_terminal():
    gray = simulator.SSD1327(96, 96)
    with simulator.serve([line(), gray], "0.0.0.0", port=0) as server:
        url = server.url.replace("0.0.0.0", "127.0.0.1")
        command = [sys.executable, "-m", "paneldraw", "view", "--terminal", url]
        child = subprocess.Popen(command, stdout=subprocess.PIPE, encoding="utf-8", env=ENVIRONMENT | UTF_8)
        assert server.wait(60)
        threading.Timer(0.5, server.close).start()
        output, _ = child.communicate(timeout=60)
        refused = started("view", "--terminal", url.partition("?")[0])
    assert child.returncode == 0
    assert "SSD1306 128x64: 1 frames, " in output
    assert "SSD1327 96x96: 0 frames, 0 bytes" in output
    rows = picture_of(output)
    assert [row.partition("│")[0] for row in rows[:32]] == drawn(line())
    assert_one_line_of_advice(refused, 1)


def test_a_page_wants_its_token():
    with simulator.serve(line(), "0.0.0.0", port=0) as server:
        url = server.url.replace("0.0.0.0", "127.0.0.1").partition("?")[0]
        done = started("view", "--terminal", url)
    assert_one_line_of_advice(done, 1)
    assert "is its token in the address?" in done.stderr


def test_without_a_browser_the_page_is_named():
    done = started("view", "--web", "http://127.0.0.1:8306/")
    assert done.stdout == "open http://127.0.0.1:8306/ in a browser, or add --terminal\n"
