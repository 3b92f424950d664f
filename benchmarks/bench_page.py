"""From the command to the page: start-up, slider and file latency, and what a large robot costs the server.

Needs a Chromium (LINKWRIGHT_CHROMIUM, or one on the PATH). Times are wall times of the whole program as a user meets
it, `linkwright` started anew each time with a warm file cache.
"""

from __future__ import annotations

import os
import shutil
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import psutil
from playwright.sync_api import Browser, Page, sync_playwright

from benchmarks.measure import Row
from benchmarks.robots import write_sweep
from linkwright.workspace import PackageFinder

RUNS = 7
MOVES = 40
SAVES = 15
FLAGS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking")


@contextmanager
def started(*words: str) -> Iterator[tuple[subprocess.Popen[str], int, float]]:
    """A `linkwright` process on a port of its own: the process, the port, and when it was started."""
    port = free_port()
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    begin = time.perf_counter()
    process = subprocess.Popen(
        [sys.executable, "-m", "linkwright", *words, "--no-open", "--port", str(port)],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=environment,
        text=True,
    )
    try:
        yield process, port, begin
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=10)


def free_port() -> int:
    """A port that nobody listens on."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def viewer_url(process: subprocess.Popen[str]) -> str:
    """The address that the program prints."""
    assert process.stdout is not None
    for line in process.stdout:
        if line.startswith("Viewer: "):
            return line.split()[1]
    raise SystemExit("the program ended without printing its address")


def answered(port: int, begin: float) -> float:
    """Seconds from `begin` until the server answers a request at all (a refusal for want of a token counts)."""
    while True:
        try:
            urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=5).close()
        except urllib.error.HTTPError:
            pass
        except OSError:
            time.sleep(0.002)
            continue
        return time.perf_counter() - begin


def drawn(page: Page, url: str) -> None:
    """Open the address and wait for the robot."""
    page.goto(url)
    page.wait_for_function("window.linkwright?.ready === true", timeout=60_000)


def start_up(browser: Browser, launch: str) -> tuple[list[float], list[float]]:
    """Seconds from the command to the first answer, and to the drawn robot."""
    answers, robots = [], []
    for _ in range(RUNS):
        with started("launch", launch) as (process, port, begin):
            answers.append(answered(port, begin))
            url = viewer_url(process)
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            drawn(page, url)
            robots.append(time.perf_counter() - begin)
            page.close()
    return answers, robots


_MOVE = """
async ([row, value]) => {
  const slider = document.querySelector(`[data-joint="${row}"] input[type=range]`);
  const before = JSON.stringify(window.linkwright.frames.left_wheel_link.orientation);
  const begin = performance.now();
  slider.value = String(value);
  slider.dispatchEvent(new Event("input", { bubbles: true }));
  while (JSON.stringify(window.linkwright.frames.left_wheel_link.orientation) === before) {
    if (performance.now() - begin > 2000) return null;
    await new Promise((next) => setTimeout(next, 1));
  }
  return performance.now() - begin;
}
"""

_SAVED = """
async ([link, z]) => {
  const limit = performance.now() + 5000;
  while (Math.abs((window.linkwright.frames[link]?.position[2] ?? NaN) - z) > 1e-6 || Number.isNaN(z)) {
    if (performance.now() > limit) return null;
    await new Promise((next) => setTimeout(next, 1));
  }
  return performance.timeOrigin + performance.now();
}
"""


def slider_latency(page: Page) -> list[float]:
    """Milliseconds from a slider's input event to the new transform in `window.linkwright.frames`."""
    times = []
    for number in range(MOVES):
        page.wait_for_timeout(37 + 13 * (number % 7))
        value = -1 + 2 * ((number * 7) % MOVES) / MOVES
        times.append(page.evaluate(_MOVE, ["left_wheel_joint", value]))
    return times


def save_latency(page: Page, model: Path) -> list[float]:
    """Milliseconds from the end of a file's writing to the changed frame in the page."""
    text = model.read_text(encoding="utf-8")
    times = []
    for number in range(SAVES):
        page.wait_for_timeout(150)
        z = -0.05 - 0.001 * (number + 1)
        model.write_text(text.replace("0 0.19 -0.05", f"0 0.19 {z:.4f}"), encoding="utf-8")
        begin = time.time() * 1000
        end = page.evaluate(_SAVED, ["left_wheel_link", z])
        times.append(end - begin)
    return times


def server_cost(browser: Browser, links: int, rate: int, seconds: float = 10) -> tuple[float, float]:
    """Share of a core that the server uses while every joint moves, and frames the page draws a second."""
    with tempfile.TemporaryDirectory() as folder:
        launch = write_sweep(Path(folder), links, rate)
        with started("launch", str(launch)) as (process, _, _):
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            drawn(page, viewer_url(process))
            time.sleep(1)
            server = psutil.Process(process.pid)
            frames = page.evaluate("() => window.linkwright.framesDrawn")
            before, begin = server.cpu_times(), time.perf_counter()
            time.sleep(seconds)
            after, elapsed = server.cpu_times(), time.perf_counter() - begin
            frames = page.evaluate("() => window.linkwright.framesDrawn") - frames
            page.close()
    used = after.user + after.system - before.user - before.system
    return 100 * used / elapsed, frames / elapsed


def row(what: str, values: list[float], unit: str, target: str) -> Row:
    """One row: the median, with the lowest and the highest."""
    return Row(f"{what} ({min(values):.3g} to {max(values):.3g})", statistics.median(values), unit, target)


def rows() -> list[Row]:
    """Measure everything."""
    chromium = os.environ.get("LINKWRIGHT_CHROMIUM") or shutil.which("chromium")
    if chromium is None:
        raise SystemExit("no Chromium: set LINKWRIGHT_CHROMIUM or put one on the PATH")
    package = PackageFinder().share("my_robot_description")
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=list(FLAGS))
        answers, robots = start_up(browser, str(package / "launch" / "display.launch.py"))
        table = [
            row("command to first HTTP answer", answers, "s", "0.7 s"),
            row("command to robot drawn", robots, "s", "2.5 s"),
        ]
        model = Path(folder) / "model.urdf"
        shutil.copy(package / "urdf" / "mbot_base.urdf", model)
        with started("view", str(model)) as (process, _, _):
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            drawn(page, viewer_url(process))
            table.append(row("slider moved to frames in the page", slider_latency(page), "ms", "50 ms"))
            table.append(row("file saved to frames in the page", save_latency(page, model), "ms", "150 ms"))
            page.close()
        cost, fps = server_cost(browser, links=500, rate=30)
        table.append(Row("server, 500 links moving at 30 Hz", cost, "% of a core", "5"))
        table.append(Row("page, 500 links moving at 30 Hz, frames drawn", fps, "1/s"))
        browser.close()
    return table
