"""A panel live on a small web page. Needs the extra ``web`` (aiohttp)."""

from __future__ import annotations

import asyncio
import hmac
import ipaddress
import json
import secrets
import threading
from collections.abc import Awaitable, Callable, Iterable
from concurrent.futures import Future
from functools import partial
from importlib.util import find_spec
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from .frames import Picture
from .looks import Look
from .recorder import Showing

if TYPE_CHECKING:
    from aiohttp import web

_POLL = 1 / 30
_ANY = ("0.0.0.0", "::")

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
  const socket = new WebSocket(`ws://${location.host}/frames${location.search}`);
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

    def __init__(
        self, chip: Showing, host: str, port: int, look: Look, names: Iterable[str], token: str | None
    ) -> None:
        self._chip = chip
        colors = json.dumps({"lit": look.lit, "dark": look.dark, "glass": look.glass})
        self._page = _PAGE.replace("LOOK", colors.replace("<", "\\u003c"))
        self._host = host
        self._names = {"localhost", host.lower(), *map(str.lower, names)}
        self._token = secrets.token_urlsafe(16) if token is None and not _loopback(host) else token
        started: Future[int] = Future()
        self._thread = threading.Thread(
            target=lambda: asyncio.run(self._main(host, port, started)), name="paneldraw-web", daemon=True
        )
        self._thread.start()
        bound = started.result()
        query = f"?token={self._token}" if self._token else ""
        self.url = f"http://{f'[{host}]' if ':' in host else host}:{bound}/{query}"

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
        runner: web.AppRunner | None = None
        try:
            app = web.Application(middlewares=[web.middleware(partial(Server._admit, self))])
            app.add_routes([web.get("/", self._answer_page), web.get("/frames", self._feed)])
            runner = web.AppRunner(app, access_log=None, shutdown_timeout=1)
            await runner.setup()
            await web.TCPSite(runner, host, port).start()
            started.set_result(runner.addresses[0][1])
            await self._stop.wait()
        except Exception as error:  # whatever it is, `serve` waits for it
            started.set_exception(error)
        finally:
            if runner is not None:
                await runner.cleanup()

    async def _admit(
        self, request: web.Request, handler: Callable[[web.Request], Awaitable[web.StreamResponse]]
    ) -> web.StreamResponse:
        """Turn away who came by a name that is not this server's, or without the token."""
        from aiohttp import web

        name = (urlsplit(f"//{request.host}").hostname or "").lower()
        if name not in self._names and not (self._host in _ANY and _is_address(name)):
            raise web.HTTPForbidden(text="this page is not there under that name")
        if self._token and not hmac.compare_digest(request.query.get("token", "").encode(), self._token.encode()):
            raise web.HTTPForbidden(text="the token of this page is missing from its address")
        return await handler(request)

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
        """The last frame: a picture between two calls, while the chip itself may be in the middle of a write."""
        try:
            return self._chip.frames[-1].pixels
        except IndexError:
            return self._chip.pixels


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _loopback(host: str) -> bool:
    return host.lower() == "localhost" or (_is_address(host) and ipaddress.ip_address(host).is_loopback)


async def _drain(socket: web.WebSocketResponse) -> None:
    """Read until the browser hangs up; without reading nobody notices."""
    async for _ in socket:
        pass


def serve(
    chip: Showing,
    host: str = "127.0.0.1",
    port: int = 8306,
    *,
    look: Look | None = None,
    names: Iterable[str] = (),
    token: str | None = None,
) -> Server:
    """Show a chip live on a web page, from a thread of its own, until the server is closed.

    Parameters
    ----------
    chip : chip
        A simulated chip.
    host : str
        Address to listen on. Default: this machine only.
    port : int
        TCP port; 0 takes a free one. Default: 8306.
    look : Look, optional
        Colors.
    names : iterable of str, optional
        Names under which browsers may ask for the page, beside ``localhost`` and `host`: a page elsewhere cannot reach
        it by a name of its own. Default: none.
    token : str, optional
        What the page's address must end with, as ``?token=``. Default: none on this machine alone; at an address that
        others can reach a new one each time, which is in the server's ``url``.

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
    ValueError
        A port that there is none of.
    """
    if find_spec("aiohttp") is None:
        raise ImportError("the live page needs aiohttp: pip install 'paneldraw[web]'")
    if not 0 <= port <= 65535:
        raise ValueError(f"port must be 0 to 65535, not {port!r}")
    return Server(chip, host, port, look or Look(), names, token)
