"""The live page: what the server sends, and what a real browser draws."""

from __future__ import annotations

import asyncio
import io
import socket
import threading
import time
from collections.abc import Awaitable, Callable, Iterator
from typing import Any

import aiohttp
import numpy as np
import pytest
from PIL import Image

from paneldraw import open_panel, simulator
from paneldraw.simulator.web import HEAD, Server

from .browsers import Browser, Page, browsers, needs_chromium, run
from .helpers import random_picture, send, started

browser = pytest.fixture(scope="module")(browsers)


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
@pytest.mark.parametrize("path", ["", "frames", "panels/0.gif"])
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


@pytest.mark.parametrize("path", ["frames", "panels/0.gif"])
@pytest.mark.parametrize("headers", [{"Origin": "http://example.org"}, {"Sec-Fetch-Site": "cross-site"}])
def test_another_sites_page_may_not_look(server: Any, path: str, headers: dict[str, str]) -> None:
    async def use(client: aiohttp.ClientSession) -> None:
        async with client.get(server.url + path, headers=headers) as response:
            assert response.status == 403

    session(use)


def test_the_page_is_the_same_for_all_and_runs_nothing_of_others(chip: simulator.SSD1306) -> None:
    async def use(client: aiohttp.ClientSession) -> None:
        async with client.get(server.url) as response:
            policy = response.headers["Content-Security-Policy"]
            assert "default-src 'none'" in policy
            assert "frame-ancestors 'none'" in policy
            assert "alert" not in await response.text()

    with simulator.serve(chip, port=0, look=simulator.Look(lit="red")) as server:
        server.add(started(96, 16), "</script><script>alert(1)</script>")
        session(use)


# -- The feed


async def picture_of(feed: aiohttp.ClientWebSocketResponse, width: int, height: int, number: int = 0) -> Any:
    data = await feed.receive_bytes()
    assert HEAD.unpack(data[: HEAD.size])[0] == number
    return np.unpackbits(np.frombuffer(data, np.uint8, offset=HEAD.size))[: width * height].reshape(height, width)


def test_frames_are_pushed_as_they_come(chip: simulator.SSD1306, server: Any) -> None:
    async def use(client: aiohttp.ClientSession) -> None:
        async with client.ws_connect(server.url + "frames") as feed:
            (about,) = (await feed.receive_json())["panels"]
            assert (about["width"], about["height"], about["bits"], about["title"]) == (128, 32, 1, "SSD1306 128x32")
            assert about["colors"] == simulator.Look().ramp(1).tolist()
            assert np.array_equal(await picture_of(feed, 128, 32), chip.frames[-1].pixels)
            for seed in range(2, 5):
                picture = show(chip, seed)
                assert np.array_equal(await picture_of(feed, 128, 32), picture)

    session(use)


def test_the_feed_counts_frames_and_bytes_that_it_does_not_send(chip: simulator.SSD1306, server: Any) -> None:
    async def use(client: aiohttp.ClientSession) -> None:
        async with client.ws_connect(server.url + "frames") as feed:
            await feed.receive_json()
            await feed.receive_bytes()
            for seed in range(2, 40):
                show(chip, seed)
            while HEAD.unpack((data := await feed.receive_bytes())[: HEAD.size])[2] < 39:
                pass
            assert HEAD.unpack(data[: HEAD.size]) == (0, 0, 39, 39 * 500, 39.0)

    session(use)


def test_panels_come_go_and_are_described(chip: simulator.SSD1306, server: Any) -> None:
    async def use(client: aiohttp.ClientSession) -> None:
        async with client.ws_connect(server.url + "frames") as feed:
            assert [about["title"] for about in (await feed.receive_json())["panels"]] == ["SSD1306 128x32"]
            await feed.receive_bytes()
            gray = simulator.SSD1327()
            await asyncio.to_thread(server.add, gray, "gray", "blue")
            about = (await feed.receive_json())["panels"][1]
            assert (about["number"], about["title"], about["bits"], len(about["colors"])) == (1, "gray", 8, 16)
            assert len(await feed.receive_bytes()) == HEAD.size + 128 * 128
            await asyncio.to_thread(server.describe, gray, "nothing yet")
            assert (await feed.receive_json())["panels"][1]["label"] == "nothing yet"
            await asyncio.to_thread(server.remove, chip)
            assert [about["number"] for about in (await feed.receive_json())["panels"]] == [1]

    session(use)


def test_a_chip_that_showed_nothing_yet_is_dark() -> None:
    async def use(client: aiohttp.ClientSession) -> None:
        async with client.ws_connect(server.url + "frames") as feed:
            await feed.receive_json()
            assert not (await picture_of(feed, 96, 16)).any()

    with simulator.serve(simulator.SSD1306(96, 16), port=0) as server:
        session(use)


def test_the_last_picture_is_sent_before_the_page_ends(chip: simulator.SSD1306) -> None:
    async def use(client: aiohttp.ClientSession) -> None:
        async with client.ws_connect(server.url + "frames") as feed:
            await feed.receive_json()
            await feed.receive_bytes()
            picture = show(chip, 9)
            await asyncio.to_thread(server.close)
            assert np.array_equal(await picture_of(feed, 128, 32), picture)
            assert (await feed.receive()).type is aiohttp.WSMsgType.CLOSE

    server = simulator.serve(chip, port=0)
    session(use)


# -- Files


@pytest.mark.parametrize(("kind", "frames"), [("gif", 3), ("png", 1)])
def test_what_a_panel_showed_can_be_downloaded(chip: simulator.SSD1306, server: Any, kind: str, frames: int) -> None:
    async def use(client: aiohttp.ClientSession) -> None:
        async with client.get(f"{server.url}panels/0.{kind}") as response:
            assert response.headers["Content-Disposition"] == f'attachment; filename="panel-1.{kind}"'
            picture = Image.open(io.BytesIO(await response.read()))
        assert (picture.size, getattr(picture, "n_frames", 1)) == ((520, 136), frames)
        for path in ("panels/7.gif", "panels/1234567890.gif", "panels/0.exe", "panels/..%2f0.gif"):
            async with client.get(server.url + path) as response:
                assert response.status == 404

    show(chip, 2)
    show(chip, 3)
    session(use)


# -- Who means it ill, or is slow


def test_rubbish_is_turned_away_and_the_page_goes_on(chip: simulator.SSD1306, server: Any) -> None:
    address = "127.0.0.1", int(server.url.rstrip("/").rpartition(":")[2])
    for rubbish in (b"\x00" * 5000, b"GET / HTTP/9.9\r\n\r\n", b"POST /frames HTTP/1.1\r\nHost: localhost\r\n\r\n"):
        with socket.create_connection(address, 10) as talk:
            talk.sendall(rubbish)
            answer = talk.recv(100)
            assert not answer or answer.split()[1][:1] == b"4"

    async def use(client: aiohttp.ClientSession) -> None:
        async with client.ws_connect(server.url + "frames") as feed, client.ws_connect(server.url + "frames") as other:
            for _ in range(100):
                await feed.send_str("nonsense")
            await feed.send_bytes(b"x" * 100_000)  # more than anybody may say
            async for message in feed:
                assert message.type is aiohttp.WSMsgType.BINARY or message.json()["panels"]
            assert feed.close_code == aiohttp.WSCloseCode.MESSAGE_TOO_BIG
            await other.receive_json()
            assert np.array_equal(await picture_of(other, 128, 32), chip.pixels)

    session(use)


def test_two_viewers_see_the_same_and_one_that_goes_leaves_the_other(chip: simulator.SSD1306, server: Any) -> None:
    async def use(client: aiohttp.ClientSession) -> None:
        async with client.ws_connect(server.url + "frames") as stays:
            goes = await client.ws_connect(server.url + "frames")
            for feed in (stays, goes):
                await feed.receive_json()
                assert np.array_equal(await picture_of(feed, 128, 32), chip.pixels)
            assert goes._response.connection is not None
            goes._response.connection.transport.abort()  # pulled out, without a word
            for seed in range(2, 6):
                picture = show(chip, seed)
                assert np.array_equal(await picture_of(stays, 128, 32), picture)
            while server._sockets > 1:
                await asyncio.sleep(0.01)

    session(use)


def test_who_never_reads_costs_no_memory_and_holds_up_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("paneldraw.simulator.web.BEAT", 0.001)
    panel = open_panel("sim://ssd1322")
    chip = panel.simulated
    server = simulator.serve(chip, port=0)
    address = "127.0.0.1", int(server.url.rstrip("/").rpartition(":")[2])
    request = f"GET /frames HTTP/1.1\r\nHost: localhost:{address[1]}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    with socket.socket() as deaf:
        deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        deaf.connect(address)
        deaf.sendall(f"{request}Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {'A' * 22}==\r\n\r\n".encode())

        async def use(client: aiohttp.ClientSession) -> None:
            async with client.ws_connect(server.url + "frames") as feed:
                await feed.receive_json()
                for seed in range(300):
                    await asyncio.to_thread(panel.show, random_picture(256, 64, seed, 15))
                    await feed.receive_bytes()

        session(use)
        assert 65_536 < buffered(server) < 200_000
        start = time.monotonic()
        server.close()
        assert time.monotonic() - start < 20
    assert not [thread for thread in threading.enumerate() if thread.name == "paneldraw-web"]


def buffered(server: Server) -> int:
    """Bytes that wait to be taken by all who are connected."""

    async def count() -> int:
        return sum(each.get_write_buffer_size() for each in vars(server._loop)["_transports"].values())

    return asyncio.run_coroutine_threadsafe(count(), server._loop).result(10)


def test_a_taken_port_is_an_os_error(chip: simulator.SSD1306) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken, pytest.raises(OSError, match="address already in use"):
        simulator.serve(chip, port=taken.getsockname()[1])


def test_closing_ends_the_feed_and_frees_the_port(chip: simulator.SSD1306) -> None:
    server = simulator.serve(chip, port=0)

    async def use(client: aiohttp.ClientSession) -> None:
        async with client.ws_connect(server.url + "frames") as feed:
            await feed.receive_json()
            await picture_of(feed, 128, 32)
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


# -- A real browser


async def colors(page: Page, number: int, shape: tuple[int, int]) -> Any:
    """The colors of a panel's canvas, shape (height, width, 3)."""
    size = f"0, 0, {shape[1]}, {shape[0]}"
    seen = await page.value(f"Array.from(panels.get({number}).pen.getImageData({size}).data)")
    return np.array(seen, np.uint8).reshape(*shape, 4)[..., :3]


@pytest.mark.thorough
@needs_chromium
def test_a_browser_draws_what_the_chip_shows(browser: Browser) -> None:
    panels = [open_panel(url) for url in ("sim://ssd1306", "sim://ssd1327", "sim://max7219?size=64x16")]
    chips = [panel.simulated for panel in panels]

    async def use() -> None:
        async with browser.page(server.url) as page:
            await page.until("panels.size === 3")
            for count in (1, 2, 3):
                for panel, chip in zip(panels, chips, strict=True):
                    panel.show(random_picture(chip.width, chip.height, count, chip.max_level))
                for number, chip in enumerate(chips):
                    frames = len(chip.frames)
                    await page.until(f"panels.get({number}).canvas.dataset.shown == {frames}")
                    look = simulator.find_look(chip.look)
                    seen = await colors(page, number, chip.pixels.shape)
                    assert np.array_equal(seen, look.colors(chip.pixels, chip.max_level))
            assert page.said == []

    with simulator.serve(chips, port=0) as server:
        run(use())


@pytest.mark.thorough
@needs_chromium
def test_pixels_are_whole_multiples_with_the_gaps_of_the_glass(browser: Browser, chip: simulator.SSD1306) -> None:
    async def use() -> None:
        async with browser.page(server.url) as page:
            await page.size(1000, 600)
            await page.until("panels.size && panels.get(0).drawn && cell > 3")
            await page.value("new Promise(requestAnimationFrame)")
            cell = int(await page.value("cell"))
            left, top = await page.value("(({x, y}) => [x, y])(panels.get(0).canvas.getBoundingClientRect())")
            seen = np.asarray(Image.open(io.BytesIO(await page.screenshot())).convert("RGB"))
            assert cell == 7
            glass = seen[round(top) :, round(left) :][: 32 * cell, : 128 * cell].reshape(32, cell, 128, cell, 3)
            wanted = simulator.Look().colors(chip.pixels)
            for y in range(cell - 1):
                for x in range(cell - 1):
                    assert np.array_equal(glass[:, y, :, x], wanted)
            assert not glass[:, -1].any()
            assert not glass[:, :, :, -1].any()

    with simulator.serve(chip, port=0) as server:
        run(use())


@pytest.mark.thorough
@needs_chromium
@pytest.mark.parametrize(("width", "height", "ratio"), [(1280, 800, 1), (390, 844, 3), (320, 480, 2), (844, 390, 3)])
def test_the_page_fits_its_window(browser: Browser, width: int, height: int, ratio: float) -> None:
    chips = [simulator.SSD1306(), simulator.SSD1327(), simulator.SSD1322()]

    async def use() -> None:
        async with browser.page(server.url) as page:
            await page.size(width, height, ratio)
            await page.until("panels.size === 3")
            for count in (3, 1):
                while await page.value("panels.size") > count:
                    await asyncio.to_thread(server.remove, server._panels[-1].sight.chip)
                    await asyncio.sleep(0.05)
                await page.value("new Promise(requestAnimationFrame)")
                assert await page.value("document.documentElement.scrollWidth <= innerWidth")
                sizes = await page.value("[...panels.values()].map(p => p.canvas.getBoundingClientRect().width)")
                cell = await page.value("cell")
                assert [size * ratio for size in sizes] == pytest.approx(
                    [w * cell for w in (128, 128, 256)[:count]], abs=0.1
                )
            assert await page.value("main.scrollHeight <= main.clientHeight")

    with simulator.serve(chips, port=0) as server:
        run(use())


@pytest.mark.thorough
@needs_chromium
def test_keys_pause_step_back_and_zoom(browser: Browser, chip: simulator.SSD1306) -> None:
    async def use() -> None:
        async with browser.page(server.url) as page:
            await page.until("panels.size && panels.get(0).drawn")
            pictures = [chip.pixels]
            for seed in range(2, 6):
                pictures.append(show(chip, seed))
                await page.until(f"panels.get(0).canvas.dataset.shown == {seed}")

            async def shows(number: int) -> bool:
                await page.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
                return bool(np.array_equal((await colors(page, 0, (32, 128)))[..., 0] > 100, pictures[number] > 0))

            assert await shows(4)
            await page.key(" ", " ")
            assert await page.value("find('pause').textContent") == "Resume"
            pictures.append(show(chip, 6))
            await page.until("panels.get(0).newest.count === 6")
            assert await shows(4)
            await page.key("ArrowLeft")
            assert await shows(3)
            for _ in range(9):
                await page.key("ArrowLeft")
            assert await shows(0)
            await page.key("ArrowRight")
            assert await shows(1)
            await page.key(" ", " ")
            assert await shows(5)
            await page.key("+", "+")
            before = await page.value("cell")
            await page.key("+", "+")
            assert await page.value("cell") == before + 1
            await page.key("0", "0")
            assert await page.value("find('zoom').value") == "0"
            await page.value("(at => { at.value = 50; at.oninput({ target: at }); })(find('brightness'))")
            assert await page.value("panels.get(0).screen.style.filter") == "brightness(50%)"

    with simulator.serve(chip, port=0) as server:
        run(use())


@pytest.mark.thorough
@needs_chromium
def test_it_can_be_listened_to(browser: Browser, chip: simulator.SSD1306) -> None:
    async def use() -> None:
        async with browser.page(server.url) as page:
            await page.until("panels.size")
            await asyncio.to_thread(server.describe, chip, "21 °C, <b>rising</b>")
            await page.until("find('words').textContent")
            tree = (await page.call("Accessibility.getFullAXTree"))["nodes"]
            named = {(node["role"]["value"], node.get("name", {}).get("value", "")) for node in tree}
            assert ("image", "SSD1306 128x32: 21 °C, <b>rising</b>") in named
            buttons = {name for role, name in named if role == "button"}
            assert {"Pause", "PNG of SSD1306 128x32", "GIF of SSD1306 128x32"} <= buttons
            assert {"Zoom", "Brightness"} <= {name for _, name in named}
            assert "SSD1306 128x32: 21 °C, <b>rising</b>" in {name for role, name in named if role == "StaticText"}

    with simulator.serve(chip, port=0) as server:
        run(use())


@pytest.mark.thorough
@needs_chromium
def test_it_is_dark_where_dark_is_preferred(browser: Browser, server: Any) -> None:
    async def use() -> None:
        async with browser.page(server.url) as page:
            brightness = {}
            for scheme in ("dark", "light"):
                await page.scheme(scheme)
                seen = await page.value(
                    "(({ backgroundColor: a, color: b }) => [a, b])(getComputedStyle(document.body))"
                )
                brightness[scheme] = [int(color.split("(")[1].split(",")[0]) for color in seen]
            assert brightness["dark"][0] < 60 < 200 < brightness["dark"][1]
            assert brightness["light"][1] < 60 < 200 < brightness["light"][0]

    run(use())


@pytest.mark.thorough
@needs_chromium
def test_a_page_outlives_its_script_and_finds_the_next(browser: Browser, chip: simulator.SSD1306) -> None:
    async def use() -> None:
        server = simulator.serve(chip, port=0)
        port = int(server.url.rstrip("/").rpartition(":")[2])
        async with browser.page(server.url) as page:
            await page.until("panels.size && panels.get(0).drawn")
            picture = show(chip, 5)
            await asyncio.to_thread(server.close)
            await page.until("find('state').textContent.includes('ended')")
            assert np.array_equal((await colors(page, 0, (32, 128)))[..., 0] > 100, picture > 0)
            with simulator.serve(simulator.SSD1327(), port=port):
                await page.until("find('state').textContent === 'live'")
                assert await page.value("[...panels.values()].map(panel => panel.about.title)") == ["SSD1327 128x128"]

    run(use())


@pytest.mark.thorough
@needs_chromium
def test_thirty_panels_at_thirty_frames_a_second(browser: Browser) -> None:
    panels = [open_panel("sim://ssd1306") for _ in range(30)]

    async def use() -> None:
        async with browser.page(server.url) as page:
            await page.size(1600, 1000)
            await page.until("panels.size === 30")
            for number in range(90):
                start = time.monotonic()
                for index, panel in enumerate(panels):
                    panel.show(random_picture(128, 64, number * 30 + index))
                await asyncio.sleep(max(0.0, start + 1 / 30 - time.monotonic()))
            for index, panel in enumerate(panels):
                await page.until(f"panels.get({index}).canvas.dataset.shown == 90")
                look = simulator.Look()
                if index in (0, 29):
                    assert np.array_equal(await colors(page, index, (64, 128)), look.colors(panel.simulated.pixels))
            assert page.said == []

    with simulator.serve([panel.simulated for panel in panels], port=0) as server:
        run(use())
