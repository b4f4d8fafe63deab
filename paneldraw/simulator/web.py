"""Panels live on a web page. Needs the extra ``web`` (aiohttp)."""

from __future__ import annotations

import asyncio
import contextlib
import hmac
import ipaddress
import secrets
import struct
import tempfile
import threading
from collections.abc import Awaitable, Callable, Iterable
from concurrent.futures import Future
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import urlsplit

import numpy as np

from .looks import Look
from .recorder import Showing, save
from .views import BEAT, Sight

if TYPE_CHECKING:
    from aiohttp import web

_ANY = ("0.0.0.0", "::")
_PAGE: Final = Path(__file__).with_name("page.html")
HEAD: Final = struct.Struct("<HHIdd")
"""Ahead of a picture: number of the panel, nothing, its pictures and bytes on the wire so far, seconds on its bus."""
_MOST_READ: Final = 1024
"""Bytes of what a browser may say, which nobody listens to."""
_LAST_WORD: Final = 1.0
"""Seconds that browsers have to take the last pictures when the page ends."""
_SECURITY: Final = {
    "Content-Security-Policy": "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
    "connect-src 'self'; img-src 'self' blob: data:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
}


class _Panel:
    """A chip on the page: its number there, and the message that its last picture is."""

    def __init__(self, number: int, sight: Sight) -> None:
        self.number, self.sight = number, sight
        self.version = 0
        self.message = self._packed()

    def glance(self) -> bool:
        """Look; return whether there is another picture."""
        if not self.sight.glance():
            return False
        self.version += 1
        self.message = self._packed()
        return True

    def _packed(self) -> bytes:
        sight = self.sight
        levels = np.packbits(sight.picture) if sight.max_level == 1 else sight.picture
        return HEAD.pack(self.number, 0, sight.frames, sight.wire_bytes, sight.seconds) + levels.tobytes()

    def described(self) -> dict[str, Any]:
        """What the page has to know before the pictures."""
        from PIL import ImageColor

        sight, look = self.sight, self.sight.look
        height, width = sight.picture.shape
        return {
            "number": self.number,
            "title": sight.title,
            "label": sight.label,
            "width": width,
            "height": height,
            "bits": 1 if sight.max_level == 1 else 8,
            "colors": look.ramp(sight.max_level).tolist(),
            "topColors": look.ramp(sight.max_level, top=True).tolist() if look.top_lit else [],
            "topRows": look.top_rows if look.top_lit else 0,
            "glass": list(ImageColor.getrgb(look.glass)[:3]),
            "gap": look.gap,
            "round": look.round,
        }


class Server:
    """A running page, made by `serve`; a context manager that stops it on leaving.

    Attributes
    ----------
    url : str
        Where a browser finds the page.
    """

    def __init__(self, host: str, port: int, names: Iterable[str], token: str | None) -> None:
        self._host = host
        self._names = {"localhost", host.lower(), *map(str.lower, names)}
        self._token = secrets.token_urlsafe(16) if token is None and not _loopback(host) else token
        self._panels: list[_Panel] = []
        self._numbers = 0
        self._edition = 0  # which panels there are, and what is said of them
        self._seen = threading.Event()
        self._sockets = 0
        self._saving: asyncio.Lock | None = None
        started: Future[int] = Future()
        self._thread = threading.Thread(
            target=lambda: asyncio.run(self._main(host, port, started)), name="paneldraw-web", daemon=True
        )
        self._thread.start()
        try:
            bound = started.result()
        except BaseException:
            self._thread.join()
            raise
        query = f"?token={self._token}" if self._token else ""
        self.url = f"http://{f'[{host}]' if ':' in host else host}:{bound}/{query}"

    def __enter__(self) -> Server:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def add(self, chip: Showing, title: str = "", look: str | Look | None = None) -> None:
        """Show one more chip, under a title."""
        sight = Sight(chip, title, look)
        self._do(lambda: self._panels.append(_Panel(self._next_number(), sight)))

    def remove(self, chip: Showing) -> None:
        """Show a chip no longer."""
        self._do(lambda: self._panels.__setitem__(slice(None), [p for p in self._panels if p.sight.chip is not chip]))

    def describe(self, chip: Showing, text: str) -> None:
        """Say in words what a chip shows, for those who have the page read to them."""

        def note() -> None:
            for panel in self._panels:
                if panel.sight.chip is chip:
                    panel.sight.label = text

        self._do(note)

    def wait(self, timeout: float) -> bool:
        """Wait until a browser has been sent pictures; return whether one has."""
        return self._seen.wait(timeout)

    def close(self) -> None:
        """Stop the page; browsers that show it are sent the last pictures, and keep them."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._stop.set)
            self._thread.join()

    def _next_number(self) -> int:
        self._numbers += 1
        return self._numbers - 1

    def _do(self, change: Callable[[], object]) -> None:
        """Change what is shown, in the thread that shows it."""

        async def doing() -> None:
            change()
            self._edition += 1
            await self._wake()

        if self._thread.is_alive():
            asyncio.run_coroutine_threadsafe(doing(), self._loop).result()

    # in the thread of the page

    async def _main(self, host: str, port: int, started: Future[int]) -> None:
        from aiohttp import web

        self._loop, self._stop, self._news = asyncio.get_running_loop(), asyncio.Event(), asyncio.Condition()
        runner: web.AppRunner | None = None
        try:
            app = web.Application(middlewares=[web.middleware(partial(Server._admit, self))])
            app.add_routes(
                [
                    web.get("/", self._answer_page),
                    web.get("/frames", self._feed),
                    web.get(r"/panels/{number:\d{1,9}}.{kind:gif|png|apng}", self._download),
                ]
            )
            runner = web.AppRunner(app, access_log=None, shutdown_timeout=_LAST_WORD)
            await runner.setup()
            await web.TCPSite(runner, host, port).start()
            started.set_result(runner.addresses[0][1])
            await self._look()
        except Exception as error:  # whatever it is, `serve` waits for it
            started.set_exception(error)
        finally:
            if runner is not None:
                await runner.cleanup()

    async def _look(self) -> None:
        """Look at all chips, again and again until the end, and once more then."""
        stopped = asyncio.create_task(self._stop.wait())
        while True:
            await asyncio.wait([stopped], timeout=BEAT)
            for panel in self._panels:
                panel.glance()
            await self._wake()
            if stopped.done():
                break
        end = self._loop.time() + _LAST_WORD
        while self._sockets and self._loop.time() < end:
            await asyncio.sleep(0.01)

    async def _wake(self) -> None:
        async with self._news:
            self._news.notify_all()

    async def _admit(
        self, request: web.Request, handler: Callable[[web.Request], Awaitable[web.StreamResponse]]
    ) -> web.StreamResponse:
        """Turn away who came by a name that is not this server's, from another site, or without the token."""
        from aiohttp import web

        name = (urlsplit(f"//{request.host}").hostname or "").lower()
        if name not in self._names and not (self._host in _ANY and _is_address(name)):
            raise web.HTTPForbidden(text="this page is not there under that name")
        if self._token and not hmac.compare_digest(request.query.get("token", "").encode(), self._token.encode()):
            raise web.HTTPForbidden(text="the token of this page is missing from its address")
        origin = request.headers.get("Origin")
        if origin is not None and urlsplit(origin).netloc != request.host:
            raise web.HTTPForbidden(text="another site's page may not look at this panel")
        if request.path != "/" and request.headers.get("Sec-Fetch-Site") in ("cross-site", "same-site"):
            raise web.HTTPForbidden(text="another site's page may not look at this panel")
        return await handler(request)

    async def _answer_page(self, request: web.Request) -> web.Response:
        from aiohttp import web

        page = await asyncio.to_thread(_PAGE.read_text, "utf-8")
        return web.Response(text=page, content_type="text/html", headers=_SECURITY)

    async def _feed(self, request: web.Request) -> web.StreamResponse:
        """Send what panels there are, and their pictures whenever they are others; a slow browser skips pictures."""
        from aiohttp import web

        socket = web.WebSocketResponse(heartbeat=20, max_msg_size=_MOST_READ, compress=False)
        await socket.prepare(request)
        listener = asyncio.create_task(_drain(socket))
        self._sockets += 1
        try:
            with contextlib.suppress(ConnectionError):
                await self._send(socket, listener)
        finally:
            self._sockets -= 1
            listener.cancel()
        with contextlib.suppress(asyncio.TimeoutError):
            await asyncio.wait_for(socket.close(), _LAST_WORD)
        return socket

    async def _send(self, socket: web.WebSocketResponse, listener: asyncio.Task[None]) -> None:
        """Send what is new until the browser hangs up or the page ends."""
        edition = -1
        sent: dict[int, int] = {}
        listener.add_done_callback(lambda _: self._loop.create_task(self._wake()))
        while not listener.done():
            last = self._stop.is_set()
            if edition != self._edition:
                edition = self._edition
                await socket.send_json({"panels": [panel.described() for panel in self._panels]})
            new = [panel for panel in self._panels if sent.get(panel.number) != panel.version]
            for panel in new:
                sent[panel.number] = panel.version
                await socket.send_bytes(panel.message)
            if self._panels:
                self._seen.set()
            if last:
                return
            async with self._news:
                if not new and edition == self._edition and not (self._stop.is_set() or listener.done()):
                    await self._news.wait()

    async def _download(self, request: web.Request) -> web.Response:
        """Send what a panel showed so far as a file."""
        from aiohttp import web

        number, kind = int(request.match_info["number"]), request.match_info["kind"]
        panel = next((panel for panel in self._panels if panel.number == number), None)
        if panel is None:
            raise web.HTTPNotFound(text="there is no such panel any more")
        if not panel.sight.frames:
            raise web.HTTPNotFound(text="this panel showed nothing yet")
        self._saving = self._saving or asyncio.Lock()
        async with self._saving:  # a file is work enough for a small machine
            body = await asyncio.to_thread(_file, panel.sight, kind)
        headers = {"Content-Disposition": f'attachment; filename="panel-{number + 1}.{kind}"'} | _SECURITY
        return web.Response(body=body, content_type=f"image/{kind}", headers=headers)


def _file(sight: Sight, kind: str) -> bytes:
    """Return what a chip showed as the bytes of a file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"panel.{kind}"
        save(sight.chip if kind == "png" else list(sight.chip.frames), path, look=sight.look)
        return path.read_bytes()


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
    chips: Showing | Iterable[Showing],
    host: str = "127.0.0.1",
    port: int = 8306,
    *,
    look: str | Look | None = None,
    names: Iterable[str] = (),
    token: str | None = None,
) -> Server:
    """Show chips live on a web page, from a thread of its own, until the server is closed.

    Parameters
    ----------
    chips : chip, or iterable of chips
        Simulated ones; ``add`` of the server takes more.
    host : str
        Address to listen on. Default: this machine only.
    port : int
        TCP port; 0 takes a free one. Default: 8306.
    look : str or Look, optional
        Default: each chip's own.
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
        A port that there is none of, or an unknown look.
    """
    if find_spec("aiohttp") is None:
        raise ImportError("the live page needs aiohttp: pip install 'paneldraw[web]'")
    if not 0 <= port <= 65535:
        raise ValueError(f"port must be 0 to 65535, not {port!r}")
    server = Server(host, port, names, token)
    try:
        for chip in [chips] if isinstance(chips, Showing) else chips:
            server.add(chip, look=look)
    except BaseException:
        server.close()
        raise
    return server
