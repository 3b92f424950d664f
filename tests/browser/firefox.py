"""An installed Firefox, driven by WebDriver BiDi.

Firefox supports this protocol itself (https://w3c.github.io/webdriver-bidi/).

Playwright drives only its own build of Firefox, and Debian has no geckodriver; decision 0065 explains the choice.
Without a display Firefox has no WebGL: on Linux that takes an X server, such as Xvfb.
"""

from __future__ import annotations

import asyncio
import base64
import contextlib
import io
import json
import os
import re
import shutil
import subprocess
import threading
from collections.abc import Callable, Coroutine, Iterator
from pathlib import Path
from typing import Any, TypeVar

import aiohttp
from PIL import Image

from tests.browser.live import POLL_PERIOD_S
from tests.waiting import TIMEOUT_S, wait_until

Result = TypeVar("Result")

_PREFERENCES = {
    "app.update.enabled": False,
    "browser.shell.checkDefaultBrowser": False,
    "browser.startup.page": 0,
    "datareporting.policy.dataSubmissionEnabled": False,
    "intl.accept_languages": "en-US",
    "webgl.force-enabled": True,  # llvmpipe draws, which Firefox does not accept as a graphics card
}


def find_firefox() -> str | None:
    """Return Firefox's program: LINKWRIGHT_FIREFOX, or one on the PATH."""
    names = ("firefox-esr", "firefox")
    return os.environ.get("LINKWRIGHT_FIREFOX") or next(filter(None, map(shutil.which, names)), None)


def can_show_windows() -> bool:
    """Return whether there is a display, or a program that replaces one."""
    return "DISPLAY" in os.environ or shutil.which("Xvfb") is not None


@contextlib.contextmanager
def launch(folder: Path, *, headless: bool = False) -> Iterator[Firefox]:
    """Run a Firefox with a new profile in a folder; a headless one has no WebGL."""
    with contextlib.ExitStack() as stack:
        environment = dict(os.environ)
        if not headless and "DISPLAY" not in environment:
            environment["DISPLAY"] = stack.enter_context(_display(folder / "xvfb.log"))
        text = "".join(f"user_pref({json.dumps(name)}, {json.dumps(value)});\n" for name, value in _PREFERENCES.items())
        (folder / "user.js").write_text(text, encoding="utf-8")
        command = [find_firefox() or "firefox", "--no-remote", "--profile", str(folder), "--remote-debugging-port=0"]
        process = _run_logged([*command, *(["--headless"] if headless else [])], environment, folder / "firefox.log")
        address = stack.enter_context(process)(r"WebDriver BiDi listening on (\S+)\n")
        yield stack.enter_context(contextlib.closing(Firefox(address)))


@contextlib.contextmanager
def _display(log: Path) -> Iterator[str]:
    """Run Xvfb, which chooses a free display number, and yield the display's name."""
    command = ["Xvfb", "-displayfd", "2", "-screen", "0", "1400x1000x24", "-nolisten", "tcp"]
    with _run_logged(command, dict(os.environ), log) as wait_for_line:
        yield ":" + wait_for_line(r"^(\d+)\n")


@contextlib.contextmanager
def _run_logged(command: list[str], environment: dict[str, str], log: Path) -> Iterator[Callable[[str], str]]:
    """Run a program, and yield a function that waits until its log matches a pattern."""

    def wait_for_line(pattern: str) -> str:
        def search() -> re.Match[str] | None:
            return re.search(pattern, log.read_text(), re.MULTILINE)

        wait_until(search, what=log.read_text)
        match = search()
        assert match is not None
        return match[1]

    with log.open("w") as output, subprocess.Popen(command, env=environment, stdout=output, stderr=output) as process:
        try:
            yield wait_for_line
        finally:
            process.terminate()
            process.wait(timeout=TIMEOUT_S)


class Firefox:
    """One tab of a running Firefox.

    Attributes:
        errors: the errors in the page's console.
    """

    def __init__(self, address: str) -> None:
        self.errors: list[str] = []
        self._number = 0
        # In another thread, because Playwright's loop counts as running in the test's thread.
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        self._socket = self._run(self._connect(address))
        self.call("session.new", capabilities={})
        self._tab = self.call("browsingContext.getTree")["contexts"][0]["context"]
        self.call("session.subscribe", events=["log.entryAdded"])
        self.resize(1280, 800)

    async def _connect(self, address: str) -> aiohttp.ClientWebSocketResponse:
        self._session = aiohttp.ClientSession()
        return await self._session.ws_connect(f"{address}/session", max_msg_size=0)

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Send a command, and return its result; errors of the page in the meantime are kept."""
        return self._run(self._call(method, parameters))

    def _run(self, coroutine: Coroutine[Any, Any, Result]) -> Result:
        return asyncio.run_coroutine_threadsafe(asyncio.wait_for(coroutine, TIMEOUT_S), self._loop).result()

    async def _call(self, method: str, parameters: dict[str, Any]) -> dict[str, Any]:
        self._number += 1
        await self._socket.send_json({"id": self._number, "method": method, "params": parameters})
        while True:
            message = await self._socket.receive_json()
            if message.get("method") == "log.entryAdded" and message["params"]["level"] == "error":
                self.errors.append(message["params"]["text"])
            if message.get("id") == self._number:
                assert message["type"] == "success", message
                return message["result"]

    def resize(self, width: int, height: int) -> None:
        self.call("browsingContext.setViewport", context=self._tab, viewport={"width": width, "height": height})

    def goto(self, url: str) -> None:
        self.call("browsingContext.navigate", context=self._tab, url=url, wait="complete")

    def evaluate(self, expression: str) -> Any:
        """Return the value of a JavaScript expression, transferred as JSON."""
        text = self.call(
            "script.evaluate",
            expression=f"JSON.stringify({expression})",
            target={"context": self._tab},
            awaitPromise=False,
        )
        assert text["type"] == "success", text
        return json.loads(text["result"].get("value", "null"))

    def until(self, condition: str) -> None:
        """Wait until a JavaScript condition over ``lw`` (window.linkwright) holds."""
        expression = f"((lw) => Boolean(lw && ({condition})))(window.linkwright)"
        wait_until(lambda: self.evaluate(expression), what=f"{condition}; {self.errors}", pause=POLL_PERIOD_S)

    def press(self, *keys: str) -> None:
        """Press keys one after another.

        WebDriver names them by a letter, or by a code such as ``\\ue014`` (right).
        """
        actions = [{"type": action_type, "value": key} for key in keys for action_type in ("keyDown", "keyUp")]
        source = {"type": "key", "id": "keyboard", "actions": actions}
        self.call("input.performActions", context=self._tab, actions=[source])

    def chord(self, modifier: str, key: str) -> None:
        """Press a key while a modifier is held down, named as in `press`."""
        steps = (("keyDown", modifier), ("keyDown", key), ("keyUp", key), ("keyUp", modifier))
        source = {
            "type": "key",
            "id": "keyboard",
            "actions": [{"type": action_type, "value": value} for action_type, value in steps],
        }
        self.call("input.performActions", context=self._tab, actions=[source])

    def point(self, x: float, y: float) -> None:
        """Move the mouse to a position in the window, in pixels."""
        move = {"type": "pointerMove", "x": round(x), "y": round(y), "duration": 20}
        source = {"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": [move]}
        self.call("input.performActions", context=self._tab, actions=[source])

    def drag(self, x: float, y: float, right: float, down: float) -> None:
        """Drag the mouse from a position in the window in five steps, in pixels."""
        moves = [
            {"type": "pointerMove", "x": round(x + right * step / 5), "y": round(y + down * step / 5), "duration": 20}
            for step in range(6)
        ]
        button = {"button": 0}
        actions = [moves[0], {"type": "pointerDown", **button}, *moves[1:], {"type": "pointerUp", **button}]
        source = {"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": actions}
        self.call("input.performActions", context=self._tab, actions=[source])

    def screenshot(self, selector: str) -> Image.Image:
        """Return a screenshot of the first element of a selector."""
        box = self.evaluate(f"document.querySelector({json.dumps(selector)}).getBoundingClientRect()")
        clip = {"type": "box", **{name: box[name] for name in ("x", "y", "width", "height")}}
        capture = self.call("browsingContext.captureScreenshot", context=self._tab, clip=clip)
        return Image.open(io.BytesIO(base64.b64decode(capture["data"]))).convert("RGB")

    def close(self) -> None:
        """Close the browser."""
        self.call("browser.close")
        self._run(self._socket.close())
        self._run(self._session.close())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(TIMEOUT_S)
        self._loop.close()
