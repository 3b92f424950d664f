"""A real Chromium and a real `linkwright` process for the tests of the page."""

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
from tests.browser.live import LOOK_EVERY, LiveViewer, configuration
from tests.browser.failure_report import what_was_seen
from tests.forked import ForkServer, start_process
from tests.waiting import wait_until

SECONDS = 60.0
"""How long the tests wait for what must come: long, for a busy machine draws a frame in seconds where it has no GPU."""

Value = TypeVar("Value")

_FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    # Without a GPU, the page around the scene is drawn in a fraction of the time by what is not OpenGL.
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
    """Let a test that fails tell what its pages showed: the next time it may not fail."""
    report = yield
    browser = getattr(item, "funcargs", {}).get("browser")
    if report.when == "call" and report.failed and browser is not None:
        name = re.sub(r"\W+", "-", item.name)
        report.sections.append(("Pages", what_was_seen(browser, item.config.rootpath / ".build" / "pages", name)))
    return report


@contextlib.contextmanager
def launched(playwright: Playwright, *flags: str) -> Iterator[Browser]:
    """A browser that draws in software, with more flags than the usual ones."""
    path = os.environ.get("LINKWRIGHT_CHROMIUM") or shutil.which("chromium")
    if path is None:
        pytest.fail("no Chromium: `make test` fetches one, or set LINKWRIGHT_CHROMIUM")
    started = playwright.chromium.launch(executable_path=path, args=[*_FLAGS, *flags])
    yield started
    started.close()


@pytest.fixture(scope="package")
def playwright() -> Iterator[Playwright]:
    """What drives browsers, once for all tests of this folder.

    Not for the session: as long as it is there its event loop counts as running, which asyncio tests must not meet.
    """
    with sync_playwright() as started:
        yield started


@pytest.fixture(scope="module")
def browser(playwright: Playwright) -> Iterator[Browser]:
    """One browser for a module, which starts in a tenth of a second: what one leaves behind no other module meets."""
    with launched(playwright) as started:
        yield started


@dataclass
class Program:
    """A running `linkwright` command; `output` is all it printed, standard error included, so far."""

    process: forked.Program
    url: str = ""
    output: list[str] = field(default_factory=list)
    _lines: queue.Queue[str | None] = field(default_factory=queue.Queue)

    def wait_for(self, pattern: str, seconds: float = SECONDS) -> re.Match[str]:
        """Read on until a line matches; fails with all the output when none does in time."""
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

    def interrupt(self, seconds: float = SECONDS) -> int:
        """Ctrl-C, and the exit status."""
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
    """A function that starts `linkwright WORDS... --no-open` and waits for the viewer's address."""
    with starting(fork_server.start, tmp_path) as run:
        yield run


@pytest.fixture
def start_fresh(tmp_path: Path) -> Iterator[Start]:
    """The same with processes that import everything themselves, as those of users do."""
    with starting(start_process, tmp_path) as run:
        yield run


@contextlib.contextmanager
def starting(start_program: Callable[..., forked.Program], folder: Path) -> Iterator[Start]:
    """What both kinds of starting have in common."""
    running: list[tuple[Program, threading.Thread]] = []

    def run(*words: str, cwd: Path = folder) -> Program:
        process = start_program(
            [*words, "--no-open"],
            cwd=cwd,
            # Robots of other tests that run at this moment must not come to this page over DDS.
            env={**os.environ, "PYTHONUNBUFFERED": "1", "NO_COLOR": "1", "LINKWRIGHT_DDS": "0"},
        )
        program = Program(process)
        reader = threading.Thread(target=program.read, daemon=True)
        reader.start()
        running.append((program, reader))
        program.url = program.wait_for(r"^Viewer: (\S+)$")[1]
        return program

    yield run
    for program, reader in running:
        if program.process.poll() is None:
            program.process.terminate()
            program.process.wait(timeout=SECONDS)
        reader.join(timeout=SECONDS)
        assert program.process.stdout is not None
        program.process.stdout.close()


@pytest.fixture
def live() -> Iterator[Callable[..., LiveViewer]]:
    """A function that starts a viewer in this process with a configuration; see `LiveViewer`."""
    running: list[LiveViewer] = []

    def run(config: str, **options: Any) -> LiveViewer:
        running.append(LiveViewer(config, **options))
        return running[-1]

    yield run
    for viewer in running:
        viewer.close()


@pytest.fixture
def open_page(browser: Browser) -> Iterator[Callable[..., Page]]:
    """A function that opens a program's page, at 1280x800 unless told otherwise, and waits for the robot."""
    contexts = []
    complaints: list[str] = []

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
        context.set_default_timeout(1000 * SECONDS)
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
        page.goto(program.url)
        if wait:
            page.wait_for_function("window.linkwright?.ready === true", polling=1000 * LOOK_EVERY)
        return page

    yield open_url
    for context in contexts:
        context.close()
    assert complaints == [], "errors in the page's console"


@pytest.fixture
def grouped(live: Callable[..., LiveViewer], open_page: Callable[..., Page]) -> tuple[LiveViewer, Page]:
    """A viewer with a grid, and axes and an unknown display in a group, and its page."""
    viewer = live(configuration(_GROUPED))
    viewer.place("tip", 1.0, 0.0, 0.0)
    page = open_page(viewer, wait=False)
    page.wait_for_selector("[data-key='display-4']")
    return viewer, page


def state(page: Page, name: str) -> Any:
    """One member of `window.linkwright`."""
    return page.evaluate(f"() => window.linkwright.{name}")


def until(page: Page, condition: str) -> None:
    """Wait until a JavaScript condition over `lw` (window.linkwright) holds."""
    page.wait_for_function(
        f"() => {{ const lw = window.linkwright; return lw && ({condition}); }}",
        timeout=1000 * SECONDS,
        polling=1000 * LOOK_EVERY,
    )


def becomes(read: Callable[[], Value], expected: Value) -> None:
    """Read again and again until it is what is expected; fails with what was read last."""
    limit = time.monotonic() + SECONDS
    while (value := read()) != expected and time.monotonic() < limit:
        time.sleep(LOOK_EVERY)
    assert value == expected


def two_seconds_pass(page: Page) -> None:
    """Wait until the page's own clock, of its Time panel, has gone on."""
    elapsed = page.locator(".time-panel .figure").last
    wait_until(elapsed.inner_text, SECONDS, pause=LOOK_EVERY)
    started = float(elapsed.inner_text())
    wait_until(lambda: float(elapsed.inner_text()) >= started + 2, SECONDS, pause=LOOK_EVERY)


def frames_drawn_meanwhile(page: Page) -> int:
    """How many frames are drawn while two seconds pass."""
    before: int = state(page, "framesDrawn")
    two_seconds_pass(page)
    after: int = state(page, "framesDrawn")
    return after - before
