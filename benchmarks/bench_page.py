"""Measure the page: start-up, latencies, frames per second, and the load of the server.

Needs a Chromium (LINKWRIGHT_CHROMIUM, or one on the PATH). Times are wall times of the whole program as a user meets
it, `linkwright` started anew each time with a warm file cache.
"""

from __future__ import annotations

import shutil
import statistics
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path

import psutil
import yaml
from playwright.sync_api import Browser

from benchmarks import peers
from benchmarks.measure import Row
from benchmarks.page_programs import (
    Core,
    answered,
    chromium,
    opened,
    plain_chromium,
    showing,
    shown_by_viser,
    started,
    viewer_url,
    watched,
)
from benchmarks.page_questions import (
    COUNT_FRAMES,
    frames_drawn,
    frames_with_drawing,
    images_shown,
    open_every_panel,
    rate_of,
    save_latency,
    scripts_loaded,
    slider_latency,
    transform_age,
    wheel_latency,
)
from benchmarks.page_seeks import seeks
from benchmarks.plain_browser import PlainBrowser
from benchmarks.robots import write_arm_sweep, write_sweep
from linkwright.bag.writing import STORAGES
from linkwright.packages import PackageFinder

RUNS = 7
MOVES = 40
SAVES = 15
TURNS = 30
SECONDS = 10.0
PAGES = 4
STAMP = "() => window.linkwright.stamp"
SETTLES = 3.0
"""The seconds until a page has determined its drawing resolution."""
CORE = "% of a core"


def row(what: str, values: list[float], unit: str, target: str = "") -> Row:
    """Return a row with the median, the minimum and the maximum."""
    return Row(f"{what} ({min(values):.3g} to {max(values):.3g})", statistics.median(values), unit, target)


def start_up(browser: Browser, *words: str, answer: str = "0.7 s", drawn: str = "2.5 s") -> list[Row]:
    """Measure the time from the command to the first response and to the drawn robot, and from opening a page."""
    answers, robots, openings = [], [], []
    size = 0.0
    for _ in range(RUNS):
        with started(*words) as (process, port, begin):
            answers.append(answered(port, begin))
            url = viewer_url(process)
            with opened(browser, url) as page:
                robots.append(time.perf_counter() - begin)
                size = scripts_loaded(page)
            begin = time.perf_counter()
            with opened(browser, url):
                openings.append(time.perf_counter() - begin)
    return [
        row(f"`{words[0]}`, command to first HTTP answer", answers, "s", answer),
        row(f"`{words[0]}`, command to robot drawn", robots, "s", drawn),
        row("page opened to robot drawn", openings, "s", "2 s"),
        Row("scripts and styles loaded until then", size, "KiB"),
    ]


def latencies(browser: Browser, package: Path) -> list[Row]:
    """Measure the latency from a slider, and from a saved file."""
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "model.urdf"
        shutil.copy(package / "urdf" / "mbot_base.urdf", model)
        with started("view", str(model)) as (process, _, _), opened(browser, viewer_url(process)) as page:
            known, drawn = slider_latency(page, MOVES)
            saved = save_latency(page, model, SAVES)
    return [
        row("slider moved to frames in the page", known, "ms", "50 ms"),
        row("slider moved to drawn frame", drawn, "ms", "100 ms"),
        row("file saved to frames in the page", saved, "ms", "150 ms"),
    ]


def robots(browser: PlainBrowser, links: int, *, server: str, page_rate: str) -> list[Row]:
    """Measure a robot of boxes, all of whose joints move at 30 Hz."""
    with tempfile.TemporaryDirectory() as folder:
        launch = write_sweep(Path(folder), links, 30)
        return moving(browser, launch, f"{links} links moving at 30 Hz", server=server, page_rate=page_rate)


def meshes(browser: PlainBrowser) -> list[Row]:
    """Measure a moving arm whose shapes are meshes."""
    with tempfile.TemporaryDirectory() as folder:
        launch = write_arm_sweep(Path(folder), 30)
        what = "an arm of 96 000 triangles moving at 30 Hz"
        return moving(browser, launch, what, server="", page_rate="30", peer="arm")


def viser(browser: PlainBrowser, scene: str) -> tuple[dict[str, float | None], dict[str, float | None]]:
    """Return the load of viser's server and its page's frame rate, for one of `viser_scenes` in the same browser."""
    if not scene:
        return {}, {}
    if peers.version("viser") is None:
        return {"viser": None}, {"viser": None}
    with (
        shown_by_viser(scene) as process,
        watched(browser, viewer_url(process), "window.framesWithDrawing > 5", COUNT_FRAMES) as page,
    ):
        time.sleep(SETTLES)
        core = Core(process)
        rate = rate_of(frames_with_drawing, page, SECONDS)
        return {"viser": core.share}, {"viser": rate}


def moving(browser: PlainBrowser, launch: Path, what: str, *, server: str, page_rate: str, peer: str = "") -> list[Row]:
    """Measure the load of the server and the frame rate while the joints of a launch file move."""
    shares, rates = viser(browser, peer)
    with ExitStack() as stack:
        process, _, _ = stack.enter_context(started("launch", str(launch)))
        page = stack.enter_context(watched(browser, viewer_url(process)))
        time.sleep(SETTLES)
        core = Core(process)
        rate = rate_of(frames_drawn, page, SECONDS)
        share = core.share
    return [
        Row(f"server, {what}", share, CORE, server, shares),
        Row(f"page, {what}, frames drawn", rate, "1/s", page_rate, rates),
    ]


def many_pages(browser: PlainBrowser, links: int) -> list[Row]:
    """Measure several pages at once, each of which receives the newest transforms at any frame rate."""
    what = f"{PAGES} browsers at once, {links} links at 30 Hz"
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        launch = write_sweep(Path(folder), links, 30)
        process, _, _ = stack.enter_context(started("launch", str(launch)))
        url = viewer_url(process)
        pages = [stack.enter_context(watched(browser, url)) for _ in range(PAGES)]
        time.sleep(1)
        core = Core(process)
        rate = rate_of(frames_drawn, pages[0], SECONDS)
        share = core.share
        age = transform_age(pages, 20)
    return [
        Row(f"server, {what}", share, CORE),
        Row(f"page, {what}, frames drawn by each", rate, "1/s", "25"),
        Row(f"age of the transforms in the slowest page, {what}", age, "ms"),
    ]


def data(
    browser: PlainBrowser, scene: str, what: str, *, server: str = "", page_rate: str = "", peer: str = ""
) -> list[Row]:
    """Measure a display of data: the load of the server, the frame rate, and the latency of the mouse."""
    shares, rates = viser(browser, peer)
    with showing(scene) as process, watched(browser, viewer_url(process), "window.linkwright?.framesDrawn > 5") as page:
        time.sleep(2)
        core = Core(process)
        rate = rate_of(frames_drawn, page, SECONDS)
        share = core.share
        turns = wheel_latency(page, TURNS)
    return [
        Row(f"server, {what}", share, CORE, server, shares),
        Row(f"page, {what}, frames drawn", rate, "1/s", page_rate, rates),
        row(f"page, {what}, wheel to drawn frame", turns, "ms"),
    ]


def images(browser: PlainBrowser) -> list[Row]:
    """Measure images in a panel, for which the scene is not drawn."""
    what = "image 640x480 at 30 Hz"
    shown = "window.linkwright?.displays[0]?.drawn?.images > 5"
    with showing("image") as process, watched(browser, viewer_url(process), shown) as page:
        time.sleep(2)
        core = Core(process)
        rate = rate_of(images_shown, page, SECONDS)
        share = core.share
    return [Row(f"server, {what}", share, CORE), Row(f"page, {what}, shown", rate, "1/s", "30")]


def demo(browser: PlainBrowser, description: Path) -> list[Row]:
    """Measure the speed of world and page in `make demo`: a robot with laser and camera in a simulated world."""
    words = ("sim", "playground", str(description / "urdf" / "mbot_gazebo.xacro"), "laser:=true", "camera:=true")
    with started(*words) as (process, _, _), watched(browser, viewer_url(process)) as page:
        time.sleep(SETTLES)
        begin = page.evaluate(STAMP)
        rate = rate_of(frames_drawn, page, SECONDS)
        passed = page.evaluate(STAMP) - begin
    return [
        Row("page, `make demo`, frames drawn", rate, "1/s", "20"),
        Row("simulated time in a second, `make demo` with its page", passed / SECONDS, "s", "1"),
    ]


def many_displays(browser: Browser, model: Path, count: int = 240) -> Row:
    """Measure the server's processor time until the page has drawn many displays without publishers."""
    kinds = ("MarkerArray", "PointCloud2", "Path", "Marker", "Pose", "Image", "LaserScan", "Map")
    displays = [
        {
            "Class": f"rviz_default_plugins/{kinds[number % len(kinds)]}",
            "Name": f"display {number}",
            "Enabled": True,
            "Topic": {"Value": f"/topic_{number}"},
        }
        for number in range(count)
    ]
    used = []
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "many.rviz"
        file.write_text(yaml.safe_dump({"Visualization Manager": {"Displays": displays}}))
        for _ in range(RUNS):
            with started("view", str(model), "-d", str(file)) as (process, _, _):
                ready = f"window.linkwright?.displays.length === {count} && window.linkwright.settled"
                with opened(browser, viewer_url(process), ready):
                    times = psutil.Process(process.pid).cpu_times()
                    used.append(times.user + times.system)
    return row(f"server, opening a .rviz of {count} displays, processor time", used, "s", "1.5 s")


def nothing(browser: Browser, model: Path) -> list[Row]:
    """Measure a robot at rest, whose nodes continue to publish while the page draws nothing."""
    with started("view", str(model)) as (process, _, _), ExitStack() as stack:
        url = viewer_url(process)
        time.sleep(3)
        core = Core(process)
        time.sleep(5)
        alone = core.share
        page = stack.enter_context(opened(browser, url))
        page.set_viewport_size({"width": 1600, "height": 1200})
        open_every_panel(page)
        time.sleep(3)
        before, core = frames_drawn(page), Core(process)
        time.sleep(5)
        drawn, share = frames_drawn(page) - before, core.share
    return [
        Row("page, nothing moves, all panels open, frames drawn in 5 s", drawn, "", "0"),
        Row("server, nothing moves, nobody watches", alone, CORE),
        Row("server, nothing moves, all panels open, more than that", share - alone, CORE, "0.5"),
    ]


def recordings(browser: PlainBrowser) -> list[Row]:
    """Measure a click on the timeline of a large recording, until frames, scan and image are drawn."""
    table = []
    for storage in STORAGES:
        size, times = seeks(browser, storage)
        table.append(row(f"seek in {size:.3g} GB ({storage}) to drawn frame and image", times, "ms", "500 ms"))
    return table


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    package = PackageFinder().share("my_robot_description")
    with chromium() as browser:
        model = package / "urdf" / "mbot_base.urdf"
        starts = [
            *start_up(browser, "view", str(model), answer="0.2 s", drawn="0.7 s"),
            *start_up(browser, "launch", str(package / "launch" / "display.launch.py")),
            *latencies(browser, package),
        ]
        still = [*nothing(browser, model), many_displays(browser, model)]
    with plain_chromium() as plain:
        return [
            *starts,
            *robots(plain, 12, server="3", page_rate="30"),
            *robots(plain, 500, server="5", page_rate="30"),
            *meshes(plain),
            *many_pages(plain, 12),
            *data(plain, "points", "100 000 points at 10 Hz", page_rate="10", peer="points"),
            *data(plain, "markers", "1000 markers at 10 Hz", page_rate="10"),
            *images(plain),
            *demo(plain, package),
            *data(plain, "scan", "500 links at 30 Hz and a scan"),
            *recordings(plain),
            *still,
        ]
