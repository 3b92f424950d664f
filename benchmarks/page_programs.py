"""Programs whose pages are measured, their processor load, and browsers that open them."""

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

from benchmarks.plain_browser import PlainBrowser, PlainPage, run_browser

CHROMIUM_FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
)
PAGE_SIZE = {"width": 1280, "height": 800}
READY_CONDITION = "window.linkwright?.ready === true"


@contextmanager
def start_linkwright(*words: str) -> Iterator[tuple[subprocess.Popen[str], int, float]]:
    """Start a `linkwright` process on a free port, and yield process, port and start time."""
    port = find_free_port()
    begin = time.perf_counter()
    with _run_program("-m", "linkwright", *words, "--no-open", "--port", str(port)) as process:
        yield process, port, begin


@contextmanager
def show_scene(scene: str) -> Iterator[subprocess.Popen[str]]:
    """Start a process that publishes and shows one of `data_scenes.SCENES`."""
    with _run_program("-m", "benchmarks.data_scenes", scene) as process:
        yield process


@contextmanager
def show_with_viser(scene: str) -> Iterator[subprocess.Popen[str]]:
    """Start a process in which viser shows one of `viser_scenes`."""
    with _run_program("-m", "benchmarks.viser_scenes", scene) as process:
        yield process


@contextmanager
def _run_program(*words: str) -> Iterator[subprocess.Popen[str]]:
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment["LINKWRIGHT_DDS"] = "0"  # nodes of other programs would be measured as well
    process = subprocess.Popen(
        [sys.executable, *words], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment, text=True
    )
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=20)


def find_free_port() -> int:
    """Return a free port."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def read_viewer_url(process: subprocess.Popen[str]) -> str:
    """Return the address that the program prints."""
    assert process.stdout is not None
    for line in process.stdout:
        if line.startswith("Viewer: "):
            return line.split()[1]
    raise SystemExit("the program ended without printing its address")


def wait_for_response(port: int, begin: float) -> float:
    """Return the seconds from `begin` until the server responds, even with a rejection."""
    while True:
        try:
            urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=5).close()
        except urllib.error.HTTPError:
            pass
        except OSError:
            time.sleep(0.002)
            continue
        return time.perf_counter() - begin


class CoreShare:
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


def _find_chromium() -> str:
    path = os.environ.get("LINKWRIGHT_CHROMIUM") or shutil.which("chromium")
    if path is None:
        raise SystemExit("no Chromium: set LINKWRIGHT_CHROMIUM or put one on the PATH")
    return path


@contextmanager
def run_chromium() -> Iterator[Browser]:
    """Run a Chromium that draws in software, driven by Playwright."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=_find_chromium(), args=list(CHROMIUM_FLAGS))
        yield browser
        browser.close()


@contextmanager
def run_plain_chromium() -> Iterator[PlainBrowser]:
    """Run the same browser without any listeners."""
    with run_browser(_find_chromium(), CHROMIUM_FLAGS) as browser:
        yield browser


@contextmanager
def open_plain_page(
    browser: PlainBrowser, url: str, ready: str = READY_CONDITION, script: str = ""
) -> Iterator[PlainPage]:
    """Open a program's page, and wait until it has drawn the robot, or another condition holds."""
    with browser.open_page(url, ready, **PAGE_SIZE, script=script) as page:
        yield page


@contextmanager
def open_page(browser: Browser, url: str, ready: str = READY_CONDITION) -> Iterator[Page]:
    """Open a program's page, and wait until it has drawn the robot, or another condition holds."""
    # Conditions are evaluated as text, which the page's security policy otherwise forbids.
    context = browser.new_context(viewport=PAGE_SIZE, bypass_csp=True, locale="en-US")  # type: ignore[arg-type]  # a dict
    page = context.new_page()
    page.goto(url)
    page.wait_for_function(ready, timeout=60_000)
    yield page
    context.close()
