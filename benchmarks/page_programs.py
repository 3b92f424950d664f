"""Programs whose pages are measured: how they are started, what they cost, and browsers that open them."""

from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager

import psutil
from playwright.sync_api import Browser, Page, sync_playwright

from benchmarks.plain_browser import PlainBrowser, PlainPage, running

FLAGS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking")
SIZE = {"width": 1280, "height": 800}
READY = "window.linkwright?.ready === true"


@contextmanager
def started(*words: str) -> Iterator[tuple[subprocess.Popen[str], int, float]]:
    """Start a `linkwright` process on a port of its own; return the process, the port, and the start time."""
    port = free_port()
    begin = time.perf_counter()
    with _running("-m", "linkwright", *words, "--no-open", "--port", str(port)) as process:
        yield process, port, begin


@contextmanager
def showing(scene: str) -> Iterator[subprocess.Popen[str]]:
    """Start a process that publishes and shows one of `data_scenes.SCENES`."""
    with _running("-m", "benchmarks.data_scenes", scene) as process:
        yield process


@contextmanager
def shown_by_viser(scene: str) -> Iterator[subprocess.Popen[str]]:
    """Start a process in which viser shows one of `viser_scenes`."""
    with _running("-m", "benchmarks.viser_scenes", scene) as process:
        yield process


@contextmanager
def _running(*words: str) -> Iterator[subprocess.Popen[str]]:
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment["LINKWRIGHT_DDS"] = "0"  # robots of others would be measured too
    process = subprocess.Popen(
        [sys.executable, *words], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment, text=True
    )
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=20)


def free_port() -> int:
    """Return a free port."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def viewer_url(process: subprocess.Popen[str]) -> str:
    """Return the address that the program prints."""
    assert process.stdout is not None
    for line in process.stdout:
        if line.startswith("Viewer: "):
            return line.split()[1]
    raise SystemExit("the program ended without printing its address")


def answered(port: int, begin: float) -> float:
    """Return the seconds from `begin` until the server answers any request, also with a rejection."""
    while True:
        try:
            urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=5).close()
        except urllib.error.HTTPError:
            pass
        except OSError:
            time.sleep(0.002)
            continue
        return time.perf_counter() - begin


class Core:
    """A measurement of the share of a core that a process uses after its creation, in percent."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = psutil.Process(process.pid)
        self._begin, self._used = time.perf_counter(), self._seconds()

    @property
    def share(self) -> float:
        """Return the share since the creation of this object."""
        return 100 * (self._seconds() - self._used) / (time.perf_counter() - self._begin)

    def _seconds(self) -> float:
        times = self._process.cpu_times()
        return times.user + times.system


def _program() -> str:
    path = os.environ.get("LINKWRIGHT_CHROMIUM") or shutil.which("chromium")
    if path is None:
        raise SystemExit("no Chromium: set LINKWRIGHT_CHROMIUM or put one on the PATH")
    return path


@contextmanager
def chromium() -> Iterator[Browser]:
    """Run a Chromium that draws in software, driven by Playwright."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=_program(), args=list(FLAGS))
        yield browser
        browser.close()


@contextmanager
def plain_chromium() -> Iterator[PlainBrowser]:
    """Run the same browser without any listeners."""
    with running(_program(), FLAGS) as browser:
        yield browser


@contextmanager
def watched(browser: PlainBrowser, url: str, ready: str = READY, script: str = "") -> Iterator[PlainPage]:
    """Open a program's page, and wait until it has drawn the robot, or another condition holds."""
    with browser.opened(url, ready, **SIZE, script=script) as page:
        yield page


@contextmanager
def opened(browser: Browser, url: str, ready: str = READY) -> Iterator[Page]:
    """Open a program's page, and wait until it has drawn the robot, or another condition holds."""
    # Conditions are evaluated as text, which the page's policy allows to nobody else.
    context = browser.new_context(viewport=SIZE, bypass_csp=True, locale="en-US")  # type: ignore[arg-type]  # a dict
    page = context.new_page()
    page.goto(url)
    page.wait_for_function(ready, timeout=60_000)
    yield page
    context.close()
