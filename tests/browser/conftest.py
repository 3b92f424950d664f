"""Fixtures with a real Chromium and a real `linkwright` process for the tests of the page."""

from __future__ import annotations

import contextlib
import os
import queue
import re
import shutil
import signal
import threading
import time
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, TypeVar

import pytest
from playwright.sync_api import Browser, Page, Playwright, sync_playwright

from tests import forked
from tests.browser.failure_report import describe_pages
from tests.browser.live import POLL_PERIOD_S, LiveViewer, configuration
from tests.forked import ForkServer, start_process
from tests.waiting import wait_until

TIMEOUT_S = 60.0
"""The tests' time limit. It is long, because a busy machine without a GPU may need seconds for a frame."""

Value = TypeVar("Value")

_FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    # Without a GPU, the page around the scene is drawn many times faster without OpenGL.
    "--disable-gpu-compositing",
    "--disable-gpu-rasterization",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
)


_GROUPED = """
- Class: rviz_default_plugins/Grid
  Enabled: true
  Name: Grid
  Value: true
- Class: rviz_common/Group
  Displays:
    - Class: rviz_default_plugins/Axes
      Enabled: true
      Name: Axes
      Value: true
    - Class: my_plugins/Radar
      Enabled: true
      Name: Radar
      Value: true
  Enabled: true
  Name: Marks
"""


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Add the content of the pages to the report of a failed test.

    The failure may not be repeatable.
    """
    report = yield
    browser = getattr(item, "funcargs", {}).get("browser")
    if report.when == "call" and report.failed and browser is not None:
        name = re.sub(r"\W+", "-", item.name)
        report.sections.append(("Pages", describe_pages(browser, item.config.rootpath / ".build" / "pages", name)))
    return report


@contextlib.contextmanager
def run_browser(playwright: Playwright, *flags: str) -> Iterator[Browser]:
    """Run a browser that draws in software, with additional flags."""
    path = os.environ.get("LINKWRIGHT_CHROMIUM") or shutil.which("chromium")
    if path is None:
        pytest.fail("Chromium is missing: `make test` downloads it, or set LINKWRIGHT_CHROMIUM")
    browser = playwright.chromium.launch(executable_path=path, args=[*_FLAGS, *flags])
    yield browser
    browser.close()


@pytest.fixture(scope="package")
def playwright() -> Iterator[Playwright]:
    """Run Playwright once for all tests of this folder.

    Not for the session: while it runs, its event loop counts as running, which asyncio tests do not allow.
    """
    with sync_playwright() as driver:
        yield driver


@pytest.fixture(scope="module")
def browser(playwright: Playwright) -> Iterator[Browser]:
    """Run a browser for each module.

    It starts in a tenth of a second, and modules do not affect each other.
    """
    with run_browser(playwright) as new_browser:
        yield new_browser


@dataclass
class Program:
    """A running `linkwright` command; `output` is its output so far, including standard error."""

    process: forked.Program
    url: str = ""
    output: list[str] = field(default_factory=list)
    _lines: queue.Queue[str | None] = field(default_factory=queue.Queue)

    def wait_for(self, pattern: str, seconds: float = TIMEOUT_S) -> re.Match[str]:
        """Read until a line matches; fail with all output after the time limit."""
        deadline = time.monotonic() + seconds
        while True:
            with contextlib.suppress(queue.Empty):
                line = self._lines.get(timeout=max(0.0, deadline - time.monotonic()))
                if line is None:
                    pytest.fail(f"the program ended before a line like {pattern!r}:\n{''.join(self.output)}")
                if match := re.search(pattern, line):
                    return match
            if time.monotonic() >= deadline:
                pytest.fail(f"no line like {pattern!r} within {seconds} s:\n{''.join(self.output)}")

    def interrupt(self, seconds: float = TIMEOUT_S) -> int:
        """Interrupt the command as Ctrl-C does, and return its exit status."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(timeout=seconds)

    def read(self) -> None:
        """Collect lines until the program closes its output; runs in a thread."""
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.output.append(line)
            self._lines.put(line)
        self._lines.put(None)


Start = Callable[..., Program]


@pytest.fixture
def start(tmp_path: Path, fork_server: ForkServer) -> Iterator[Start]:
    """Return a function that starts `linkwright WORDS... --no-open`.

    It waits for the viewer's address.
    """
    with program_starter(fork_server.start, tmp_path) as run:
        yield run


@pytest.fixture
def start_fresh(tmp_path: Path) -> Iterator[Start]:
    """Return the same function with processes that import everything themselves.

    Users' processes do so.
    """
    with program_starter(start_process, tmp_path) as run:
        yield run


@contextlib.contextmanager
def program_starter(start_program: Callable[..., forked.Program], folder: Path) -> Iterator[Start]:
    """Yield a function that starts a command, and end the commands afterwards."""
    programs: list[tuple[Program, threading.Thread]] = []

    def run(*arguments: str, cwd: Path = folder) -> Program:
        process = start_program(
            [*arguments, "--no-open"],
            cwd=cwd,
            # Robots of other tests that run at the same time must not appear in this page over DDS.
            env={**os.environ, "PYTHONUNBUFFERED": "1", "NO_COLOR": "1", "LINKWRIGHT_DDS": "0"},
        )
        program = Program(process)
        reader = threading.Thread(target=program.read, daemon=True)
        reader.start()
        programs.append((program, reader))
        program.url = program.wait_for(r"^Viewer: (\S+)$")[1]
        return program

    yield run
    for program, reader in programs:
        if program.process.poll() is None:
            program.process.terminate()
            program.process.wait(timeout=TIMEOUT_S)
        reader.join(timeout=TIMEOUT_S)
        assert program.process.stdout is not None
        program.process.stdout.close()


@pytest.fixture
def start_viewer() -> Iterator[Callable[..., LiveViewer]]:
    """Return a function that starts a viewer in this process with a configuration.

    See `LiveViewer`.
    """
    viewers: list[LiveViewer] = []

    def run(config: str, **options: Any) -> LiveViewer:
        viewers.append(LiveViewer(config, **options))
        return viewers[-1]

    yield run
    for viewer in viewers:
        viewer.close()


@pytest.fixture
def open_page(browser: Browser) -> Iterator[Callable[..., Page]]:
    """Return a function that opens a program's page and waits for the robot.

    The page has 1280x800 pixels by default.
    """
    contexts = []
    errors: list[str] = []

    def open_url(
        program: Program | LiveViewer,
        *,
        wait: bool = True,
        size: tuple[int, int] = (1280, 800),
        theme: Literal["light", "dark"] = "light",
    ) -> Page:
        context = browser.new_context(
            viewport={"width": size[0], "height": size[1]}, locale="en-US", color_scheme=theme
        )
        context.set_default_timeout(1000 * TIMEOUT_S)
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
        page.goto(program.url)
        if wait:
            page.wait_for_function("window.linkwright?.ready === true", polling=1000 * POLL_PERIOD_S)
        return page

    yield open_url
    for context in contexts:
        context.close()
    assert errors == [], "errors in the page's console"


@pytest.fixture
def grouped_displays(
    start_viewer: Callable[..., LiveViewer], open_page: Callable[..., Page]
) -> tuple[LiveViewer, Page]:
    """Return a viewer and its page.

    The viewer has a grid, and a group of axes and an unknown display.
    """
    viewer = start_viewer(configuration(_GROUPED))
    viewer.place("tip", 1.0, 0.0, 0.0)
    page = open_page(viewer, wait=False)
    page.wait_for_selector("[data-key='display-4']")
    return viewer, page


def state(page: Page, name: str) -> Any:
    """Return a member of `window.linkwright`."""
    return page.evaluate(f"() => window.linkwright.{name}")


def until(page: Page, condition: str) -> None:
    """Wait until a JavaScript condition over `lw` (window.linkwright) holds."""
    page.wait_for_function(
        f"() => {{ const lw = window.linkwright; return lw && ({condition}); }}",
        timeout=1000 * TIMEOUT_S,
        polling=1000 * POLL_PERIOD_S,
    )


def wait_until_equal(read: Callable[[], Value], expected: Value) -> None:
    """Read a value repeatedly until it is the expected one; fail with the last value."""
    limit = time.monotonic() + TIMEOUT_S
    while (value := read()) != expected and time.monotonic() < limit:
        time.sleep(POLL_PERIOD_S)
    assert value == expected


def wait_two_seconds(page: Page) -> None:
    """Wait until the clock of the page's Time panel has advanced by two seconds."""
    elapsed = page.locator(".time-panel .figure").last
    wait_until(elapsed.inner_text, TIMEOUT_S, pause=POLL_PERIOD_S)
    start = float(elapsed.inner_text())
    wait_until(lambda: float(elapsed.inner_text()) >= start + 2, TIMEOUT_S, pause=POLL_PERIOD_S)


def count_frames(page: Page) -> int:
    """Return the number of frames that are drawn in two seconds."""
    first: int = state(page, "framesDrawn")
    wait_two_seconds(page)
    last: int = state(page, "framesDrawn")
    return last - first
