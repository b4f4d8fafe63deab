"""A headless Chromium for tests, driven through its debugging protocol."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import shutil
import subprocess
import tempfile
import time
from collections.abc import AsyncIterator, Coroutine, Iterator
from pathlib import Path
from typing import Any, TypeVar

import aiohttp
import pytest

T = TypeVar("T")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium: apt-get install chromium")


def run(work: Coroutine[Any, Any, T]) -> T:
    """Run what waits for a browser."""
    return asyncio.run(asyncio.wait_for(work, 120))


class Page:
    """A page in a browser."""

    def __init__(self, socket: aiohttp.ClientWebSocketResponse) -> None:
        self._socket = socket
        self._number = 0
        self.said: list[str] = []

    async def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Call a method of the protocol."""
        self._number += 1
        await self._socket.send_json({"id": self._number, "method": method, "params": parameters})
        while True:
            reply = await self._socket.receive_json()
            if reply.get("method") in ("Runtime.exceptionThrown", "Log.entryAdded"):
                self.said.append(str(reply["params"]))
            if reply.get("id") == self._number:
                assert "error" not in reply, reply
                return dict(reply["result"])

    async def value(self, expression: str) -> Any:
        """Return what an expression gives, awaited."""
        done = await self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in done, done
        return done["result"].get("value")

    async def until(self, condition: str) -> None:
        """Wait until a condition holds."""
        deadline = time.monotonic() + 30
        while not await self.value(f"!!({condition})"):
            assert time.monotonic() < deadline, condition
            await asyncio.sleep(0.02)

    async def key(self, key: str, text: str = "") -> None:
        """Press a key."""
        await self.call("Input.dispatchKeyEvent", type="keyDown", key=key, **({"text": text} if text else {}))
        await self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    async def size(self, width: int, height: int, ratio: float = 1) -> None:
        """Make the window so large, in CSS pixels, with so many pixels of the screen to each."""
        screen = {"width": width, "height": height, "deviceScaleFactor": ratio, "mobile": False}
        await self.call("Emulation.setDeviceMetricsOverride", **screen)

    async def scheme(self, name: str) -> None:
        """Prefer ``"dark"`` or ``"light"``."""
        wanted = {"name": "prefers-color-scheme", "value": name}
        await self.call("Emulation.setEmulatedMedia", features=[wanted])

    async def screenshot(self) -> bytes:
        """Return what is seen as a PNG."""
        return base64.b64decode((await self.call("Page.captureScreenshot", format="png"))["data"])


class Browser:
    """A browser; a context manager that ends it."""

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        options = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--remote-debugging-port=0"]
        self._process = subprocess.Popen(
            [CHROMIUM or "", *options, f"--user-data-dir={self._folder.name}", "about:blank"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def __enter__(self) -> Browser:
        return self

    def __exit__(self, *exception: object) -> None:
        self._process.terminate()
        self._process.wait(30)
        self._folder.cleanup()

    def _address(self) -> str:
        port_file = Path(self._folder.name) / "DevToolsActivePort"
        deadline = time.monotonic() + 60
        while not (port_file.exists() and port_file.read_text().count("\n")):
            if self._process.poll() is not None or time.monotonic() > deadline:
                pytest.fail("Chromium did not start")
            time.sleep(0.05)
        return f"http://127.0.0.1:{port_file.read_text().split()[0]}"

    @contextlib.asynccontextmanager
    async def page(self, url: str) -> AsyncIterator[Page]:
        """Open a page; it closes on leaving."""
        address = self._address()
        async with aiohttp.ClientSession() as client:
            async with client.put(f"{address}/json/new?about:blank") as answer:
                target = await answer.json()
            async with client.ws_connect(target["webSocketDebuggerUrl"], max_msg_size=0) as socket:
                page = Page(socket)
                await page.call("Runtime.enable")
                await page.call("Log.enable")
                await page.call("Page.enable")
                await page.call("Page.navigate", url=url)
                await page.until("document.readyState === 'complete' && document.querySelector('main')")
                yield page
            async with client.get(f"{address}/json/close/{target['id']}"):
                pass


def browsers() -> Iterator[Browser]:
    """Yield a browser, as a fixture does."""
    with Browser() as browser:
        yield browser
