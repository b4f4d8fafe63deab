"""A panel live on a small web page. Needs the extra ``web`` (aiohttp)."""

from __future__ import annotations

import asyncio
import json
import threading
from concurrent.futures import Future
from importlib.util import find_spec
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from .frames import Picture
from .recorder import Look, Showing

if TYPE_CHECKING:
    from aiohttp import web

_POLL = 1 / 30

_PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>paneldraw</title>
<style>
body { margin: 0; min-height: 100vh; display: grid; place-content: center; background: #30343a; color: #c8ccd0;
       font: 14px sans-serif; text-align: center }
canvas { image-rendering: pixelated; max-width: 96vw; border-radius: 4px }
</style>
<canvas width="1" height="1"></canvas><p></p>
<script>
const look = LOOK, canvas = document.querySelector("canvas"), note = document.querySelector("p"), cell = 6;
const pen = canvas.getContext("2d");
const parse = color => { pen.fillStyle = color; pen.fillRect(0, 0, 1, 1); return pen.getImageData(0, 0, 1, 1).data; };
const dark = parse(look.dark), lit = parse(look.lit);
let panel, shown = 0;
function draw(levels) {
  for (let i = 0; i < levels.length; i++) {
    const share = levels[i] / panel.max_level;
    pen.fillStyle = `rgb(${[0, 1, 2].map(k => Math.round(dark[k] + (lit[k] - dark[k]) * share))})`;
    pen.fillRect((1 + i % panel.width) * cell, (1 + Math.floor(i / panel.width)) * cell, cell - 1, cell - 1);
  }
  canvas.dataset.shown = ++shown;
}
function connect() {
  const socket = new WebSocket(`ws://${location.host}/frames`);
  socket.binaryType = "arraybuffer";
  socket.onmessage = ({ data }) => {
    if (typeof data !== "string") return draw(new Uint8Array(data));
    panel = JSON.parse(data);
    canvas.width = (panel.width + 2) * cell;
    canvas.height = (panel.height + 2) * cell;
    pen.fillStyle = look.glass;
    pen.fillRect(0, 0, canvas.width, canvas.height);
    note.textContent = `${panel.width} x ${panel.height}, live`;
  };
  socket.onclose = () => { note.textContent = "the panel is gone; trying again"; setTimeout(connect, 1000); };
}
connect();
</script>
</html>
"""


class Server:
    """A running page, made by `serve`; a context manager that stops it on leaving.

    Attributes
    ----------
    url : str
        Where a browser finds the page.
    """

    def __init__(self, chip: Showing, host: str, port: int, look: Look) -> None:
        self._chip = chip
        self._page = _PAGE.replace("LOOK", json.dumps({"lit": look.lit, "dark": look.dark, "glass": look.glass}))
        started: Future[int] = Future()
        self._thread = threading.Thread(
            target=lambda: asyncio.run(self._main(host, port, started)), name="paneldraw-web", daemon=True
        )
        self._thread.start()
        bound = started.result()
        self.url = f"http://{f'[{host}]' if ':' in host else host}:{bound}/"

    def __enter__(self) -> Server:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def close(self) -> None:
        """Stop the page; browsers that show it keep the last picture."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._stop.set)
            self._thread.join()

    async def _main(self, host: str, port: int, started: Future[int]) -> None:
        from aiohttp import web

        self._loop, self._stop = asyncio.get_running_loop(), asyncio.Event()
        app = web.Application()
        app.add_routes([web.get("/", self._answer_page), web.get("/frames", self._feed)])
        runner = web.AppRunner(app, access_log=None, shutdown_timeout=1)
        try:
            await runner.setup()
            await web.TCPSite(runner, host, port).start()
            started.set_result(runner.addresses[0][1])
            await self._stop.wait()
        except OSError as error:
            started.set_exception(error)
        finally:
            await runner.cleanup()

    async def _answer_page(self, request: web.Request) -> web.Response:
        from aiohttp import web

        return web.Response(text=self._page, content_type="text/html")

    async def _feed(self, request: web.Request) -> web.StreamResponse:
        """Send the panel's size, and then its picture whenever it is another; a slow browser skips pictures."""
        from aiohttp import web

        origin = request.headers.get("Origin")
        if origin is not None and urlsplit(origin).netloc != request.host:
            raise web.HTTPForbidden(text="another site's page may not look at this panel")
        socket = web.WebSocketResponse(heartbeat=20)
        await socket.prepare(request)
        picture = self._picture()
        height, width = picture.shape
        await socket.send_json({"width": width, "height": height, "max_level": self._chip.max_level})
        listener = asyncio.create_task(_drain(socket))
        sent: Picture | None = None
        while not (listener.done() or self._stop.is_set()):
            if picture is not sent:
                await socket.send_bytes(picture.tobytes())
                sent = picture
            await asyncio.sleep(_POLL)
            picture = self._picture()
        listener.cancel()
        await socket.close()
        return socket

    def _picture(self) -> Picture:
        """The last frame; frames are whole, while the chip itself may be in the middle of a write."""
        try:
            return self._chip.frames[-1].pixels
        except IndexError:
            return self._chip.pixels


async def _drain(socket: web.WebSocketResponse) -> None:
    """Read until the browser hangs up; without reading nobody notices."""
    async for _ in socket:
        pass


def serve(chip: Showing, host: str = "127.0.0.1", port: int = 8306, *, look: Look | None = None) -> Server:
    """Show a chip live on a web page, from a thread of its own, until the server is closed.

    Parameters
    ----------
    chip : chip
        A simulated chip.
    host : str
        Address to listen on. Default: this machine only. The page has no password: whoever reaches another address
        that you give here sees the panel.
    port : int
        TCP port; 0 takes a free one. Default: 8306.
    look : Look, optional
        Colors.

    Returns
    -------
    Server
        The running server, with its ``url``; use it in a ``with`` block or close it.

    Raises
    ------
    ImportError
        Without aiohttp.
    OSError
        Where the port is taken or the address is not this machine's.
    """
    if find_spec("aiohttp") is None:
        raise ImportError("the live page needs aiohttp: pip install 'paneldraw[web]'")
    return Server(chip, host, port, look or Look())
