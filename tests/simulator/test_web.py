"""The live page: what the server sends, and what a real browser draws."""

from __future__ import annotations

import asyncio
import shutil
import socket
import subprocess
import tempfile
import time
from collections.abc import Awaitable, Callable, Iterator
from pathlib import Path
from typing import Any

import aiohttp
import numpy as np
import pytest

from paneldraw import simulator

from .helpers import random_picture, send, started

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


@pytest.fixture
def chip() -> simulator.SSD1306:
    chip = started(128, 32)
    show(chip, 1)
    return chip


def show(chip: simulator.SSD1306, seed: int) -> np.ndarray[Any, Any]:
    picture = random_picture(chip.width, chip.height, seed)
    send(chip, picture)
    chip.settle(float(seed), 500)
    return picture


@pytest.fixture
def server(chip: simulator.SSD1306) -> Iterator[Any]:
    with simulator.serve(chip, port=0) as server:
        yield server


def session(use: Callable[[aiohttp.ClientSession], Awaitable[None]]) -> None:
    async def run() -> None:
        async with aiohttp.ClientSession() as client:
            await use(client)

    asyncio.run(asyncio.wait_for(run(), 60))


def test_only_this_machine_is_served_by_default(server: Any) -> None:
    assert server.url.startswith("http://127.0.0.1:")


@pytest.mark.parametrize("name", ["localhost", "127.0.0.1", "panel.home"])
def test_names_that_are_the_servers(chip: simulator.SSD1306, name: str) -> None:
    with simulator.serve(chip, port=0, names=["Panel.home"]) as server:
        assert answer(server.url, name) == 200


@pytest.mark.parametrize("name", ["evil.example", "127.0.0.1.evil.example", "", "10.0.0.1"])
@pytest.mark.parametrize("path", ["", "frames"])
def test_a_foreign_host_gets_nothing(server: Any, name: str, path: str) -> None:
    assert answer(server.url + path, name) == 403


def answer(url: str, name: str) -> int:
    """The status with which a server answers somebody who calls it by a name."""
    status = 0

    async def use(client: aiohttp.ClientSession) -> None:
        nonlocal status
        async with client.get(url, headers={"Host": name}) as response:
            status = response.status

    session(use)
    return status


def test_an_address_that_others_can_reach_needs_the_token(chip: simulator.SSD1306) -> None:
    with simulator.serve(chip, "0.0.0.0", port=0) as server:
        page, _, token = server.url.partition("?token=")
        assert len(token) >= 20
        assert answer(server.url, "192.168.1.5") == 200
        assert answer(page, "192.168.1.5") == 403
        assert answer(page + "?token=wrong", "192.168.1.5") == 403
        assert answer(server.url, "evil.example") == 403
        assert answer(f"{page}frames", "192.168.1.5") == 403
    with simulator.serve(chip, "0.0.0.0", port=0, token="mine") as server:
        assert server.url.endswith("/?token=mine")
    with simulator.serve(chip, port=0) as server:
        assert "token" not in server.url


@pytest.mark.parametrize(
    ("host", "port", "kind"),
    [
        ("127.0.0.1", 70000, ValueError),
        ("127.0.0.1", -1, ValueError),
        ("192.0.2.1", 0, OSError),
        ("a" * 300, 0, UnicodeError),
    ],
)
def test_a_place_that_cannot_be_is_refused_at_once(
    chip: simulator.SSD1306, host: str, port: int, kind: type[Exception]
) -> None:
    with pytest.raises(kind):
        simulator.serve(chip, host, port)


def test_colors_cannot_end_the_script(chip: simulator.SSD1306) -> None:
    text = ""

    async def use(client: aiohttp.ClientSession) -> None:
        nonlocal text
        async with client.get(server.url) as response:
            text = await response.text()

    with simulator.serve(chip, port=0, look=simulator.Look(lit="</script><script>alert(1)")) as server:
        session(use)
    assert text.count("<script>") == 1


def test_frames_are_pushed_as_they_come(chip: simulator.SSD1306, server: Any) -> None:
    async def use(client: aiohttp.ClientSession) -> None:
        async with client.ws_connect(server.url + "frames") as feed:
            assert await feed.receive_json() == {"width": 128, "height": 32, "max_level": 1}
            assert await feed.receive_bytes() == chip.frames[-1].pixels.tobytes()
            for seed in range(2, 5):
                picture = show(chip, seed)
                assert await feed.receive_bytes() == picture.tobytes()

    session(use)


def test_a_chip_that_showed_nothing_yet_is_dark() -> None:
    async def use(client: aiohttp.ClientSession) -> None:
        async with client.ws_connect(server.url + "frames") as feed:
            await feed.receive_json()
            assert await feed.receive_bytes() == bytes(96 * 16)

    with simulator.serve(simulator.SSD1306(96, 16), port=0) as server:
        session(use)


def test_another_sites_page_may_not_look(server: Any) -> None:
    async def use(client: aiohttp.ClientSession) -> None:
        with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
            await client.ws_connect(server.url + "frames", headers={"Origin": "http://example.org"})
        assert refused.value.status == 403

    session(use)


def test_a_taken_port_is_an_os_error(chip: simulator.SSD1306) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken, pytest.raises(OSError, match="address already in use"):
        simulator.serve(chip, port=taken.getsockname()[1])


def test_closing_ends_the_feed_and_frees_the_port(chip: simulator.SSD1306) -> None:
    server = simulator.serve(chip, port=0)

    async def use(client: aiohttp.ClientSession) -> None:
        async with client.ws_connect(server.url + "frames") as feed:
            await feed.receive_json()
            await feed.receive_bytes()
            await asyncio.to_thread(server.close)
            assert (await feed.receive()).type in (aiohttp.WSMsgType.CLOSE, aiohttp.WSMsgType.CLOSED)

    session(use)
    server.close()
    again = simulator.serve(chip, port=int(server.url.rstrip("/").rpartition(":")[2]))
    again.close()


def test_without_aiohttp_the_message_says_what_to_install(
    chip: simulator.SSD1306, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("paneldraw.simulator.web.find_spec", lambda name: None)
    with pytest.raises(ImportError, match=r"paneldraw\[web\]"):
        simulator.serve(chip)


class Browser:
    """A headless Chromium, asked through its debugging protocol."""

    def __init__(self, folder: Path) -> None:
        command = [CHROMIUM or "", "--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-port=0"]
        self.process = subprocess.Popen(
            [*command, f"--user-data-dir={folder}", "about:blank"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        self.folder = folder

    def debugger(self) -> str:
        port_file = self.folder / "DevToolsActivePort"
        deadline = time.monotonic() + 60
        while not (port_file.exists() and port_file.read_text().count("\n")):
            if self.process.poll() is not None or time.monotonic() > deadline:
                pytest.fail("Chromium did not start")
            time.sleep(0.05)
        return f"http://127.0.0.1:{port_file.read_text().split()[0]}"

    def close(self) -> None:
        self.process.terminate()
        self.process.wait(30)


@pytest.fixture
def browser() -> Iterator[Browser]:
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        browser = Browser(Path(folder))
        yield browser
        browser.close()


LIT_CELLS = """
new Promise(done => {
  const look = () => {
    const canvas = document.querySelector("canvas");
    if (Number(canvas?.dataset.shown || 0) < WANTED) return setTimeout(look, 20);
    const pen = canvas.getContext("2d"), cell = 6, rows = [];
    for (let y = cell; y < canvas.height - cell; y += cell) {
      let row = "";
      for (let x = cell; x < canvas.width - cell; x += cell) row += pen.getImageData(x, y, 1, 1).data[0] > 100 ? 1 : 0;
      rows.push(row);
    }
    done(rows.join("\\n"));
  };
  look();
})
"""


@pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium: apt-get install chromium")
def test_a_browser_draws_every_frame(chip: simulator.SSD1306, server: Any, browser: Browser) -> None:
    def lit(picture: np.ndarray[Any, Any]) -> str:
        return "\n".join("".join(map(str, row)) for row in picture)

    async def use(client: aiohttp.ClientSession) -> None:
        async with client.put(f"{browser.debugger()}/json/new?{server.url}") as answer:
            target = (await answer.json())["webSocketDebuggerUrl"]
        async with client.ws_connect(target) as debugger:

            async def drawn(wanted: int) -> str:
                """What the canvas shows after so many frames; asked again while the page is still loading."""
                expression = LIT_CELLS.replace("WANTED", str(wanted))
                while True:
                    request = {"expression": expression, "awaitPromise": True}
                    await debugger.send_json({"id": 1, "method": "Runtime.evaluate", "params": request})
                    reply = await debugger.receive_json()
                    if "value" in reply.get("result", {}).get("result", {}):
                        return str(reply["result"]["result"]["value"])

            assert await drawn(1) == lit(chip.frames[-1].pixels)
            for count in (2, 3):
                picture = show(chip, 10 + count)
                assert await drawn(count) == lit(picture)

    session(use)
