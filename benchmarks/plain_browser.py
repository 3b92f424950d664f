"""A Chromium that only evaluates expressions, through the DevTools protocol.

With Playwright, the browser reports every WebSocket message with all its bytes, which for point clouds costs as much as
the page itself. So pages that receive data are measured in this browser.
"""

from __future__ import annotations

import asyncio
import json
import os
import re
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from typing import Any

import aiohttp

TIMEOUT_S = 60.0
"""The timeout for pages, in seconds."""


class PlainBrowser:
    """A running Chromium.

    Args:
        address: the address of the browser's DevTools socket, ``ws://...``.
    """

    def __init__(self, address: str) -> None:
        self._pages = address.rpartition("/devtools/")[0] + "/devtools/page/"
        self._socket = Socket(address)

    @contextmanager
    def open_page(self, url: str, ready: str, width: int, height: int, script: str = "") -> Iterator[PlainPage]:
        """Yield a page with its own storage, once a condition holds.

        `script` runs before the scripts of the page.
        """
        context = self._socket.call("Target.createBrowserContext")["browserContextId"]
        target = self._socket.call("Target.createTarget", url="about:blank", browserContextId=context)["targetId"]
        with closing(PlainPage(Socket(self._pages + target))) as page:
            page.open(url, ready, width, height, script)
            yield page
        self._socket.call("Target.disposeBrowserContext", browserContextId=context)

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()


class PlainPage:
    """A page of a `PlainBrowser`, with the methods of Playwright that measurements need."""

    def __init__(self, socket: Socket) -> None:
        self._socket = socket

    def open(self, url: str, ready: str, width: int, height: int, script: str = "") -> None:
        """Open an address at a size in pixels, and wait for a condition.

        `script` runs before the scripts of the page.
        """
        if script:
            self._socket.call("Page.enable")
            self._socket.call("Page.addScriptToEvaluateOnNewDocument", source=script)
        self._socket.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False
        )
        self._socket.call("Emulation.setFocusEmulationEnabled", enabled=True)
        self._socket.call("Page.navigate", url=url)
        self.wait_until(ready)

    def wait_until(self, condition: str) -> Any:
        """Wait until an expression is truthy, and return its value."""
        end = time.monotonic() + TIMEOUT_S
        while not (value := self.evaluate(f"() => {condition}")):
            if time.monotonic() > end:
                raise SystemExit(f"not within {TIMEOUT_S:g} s: {condition}")
            time.sleep(0.05)
        return value

    def evaluate(self, function: str) -> Any:
        """Return the result of a JavaScript function without arguments."""
        result = self._socket.call("Runtime.evaluate", expression=f"({function})()", returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"]["text"])
        return result["result"].get("value")

    def wheel(self, x: float, y: float, distance: float) -> None:
        """Turn the mouse wheel at a position of the page."""
        self._socket.call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=distance)

    def click(self, x: float, y: float) -> None:
        """Click at a position of the page."""
        for kind in ("mousePressed", "mouseReleased"):
            self._socket.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()


class Socket:
    """A socket of the DevTools protocol, which sends commands and returns their results."""

    def __init__(self, address: str) -> None:
        self._number = 0
        self._loop = asyncio.new_event_loop()
        self._loop.run_until_complete(self._open(address))

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Return the result of a command."""
        return self._loop.run_until_complete(asyncio.wait_for(self._call(method, parameters), TIMEOUT_S))

    def close(self) -> None:
        """Close the socket."""
        self._loop.run_until_complete(self._session.close())
        self._loop.close()

    async def _open(self, address: str) -> None:
        self._session = aiohttp.ClientSession()
        self._socket = await self._session.ws_connect(address, max_msg_size=0)

    async def _call(self, method: str, parameters: dict[str, Any]) -> dict[str, Any]:
        self._number += 1
        await self._socket.send_json({"id": self._number, "method": method, "params": parameters})
        while True:
            answer: dict[str, Any] = json.loads(await self._socket.receive_str())
            if answer.get("id") != self._number:
                continue
            if "error" in answer:
                raise RuntimeError(f"{method}: {answer['error']['message']}")
            result: dict[str, Any] = answer["result"]
            return result


@contextmanager
def run_browser(program: str, flags: tuple[str, ...]) -> Iterator[PlainBrowser]:
    """Run a Chromium with a temporary profile."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        own_flags = ("--headless", "--remote-debugging-port=0", f"--user-data-dir={profile}", "--no-first-run")
        # In the locale C, the browser reports a language that Intl does not know.
        environment = os.environ | {"LC_ALL": "en_US.UTF-8"}
        words = [program, *flags, *own_flags, "about:blank"]
        process = subprocess.Popen(words, stderr=subprocess.PIPE, env=environment, text=True)
        try:
            assert process.stderr is not None
            match = next(filter(None, (re.search(r"listening on (ws://\S+)", line) for line in process.stderr)), None)
            if match is None:
                raise SystemExit("the browser ended without saying where it listens")
            with closing(PlainBrowser(match[1])) as browser:
                yield browser
        finally:
            process.terminate()
            process.wait(timeout=TIMEOUT_S)
