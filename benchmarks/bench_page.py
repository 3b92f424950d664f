"""Measure the page: start-up, latencies, frames per second, and the load of the server.

Needs a Chromium (LINKWRIGHT_CHROMIUM, or one on the PATH). Times are wall times of the whole program as for a user:
each run is a new `linkwright` process with a warm file cache.
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
    CoreShare,
    open_page,
    open_plain_page,
    read_viewer_url,
    run_chromium,
    run_plain_chromium,
    show_scene,
    show_with_viser,
    start_linkwright,
    wait_for_response,
)
from benchmarks.page_questions import (
    COUNT_FRAMES,
    count_drawing_frames,
    count_frames,
    count_images,
    measure_rate,
    measure_save_latency,
    measure_scripts,
    measure_slider_latency,
    measure_transform_age,
    measure_wheel_latency,
    open_every_panel,
)
from benchmarks.page_seeks import measure_seeks
from benchmarks.plain_browser import PlainBrowser
from benchmarks.robots import write_arm_sweep, write_sweep
from linkwright.bag.writing import STORAGES
from linkwright.packages import PackageFinder

RUN_COUNT = 7
MOVE_COUNT = 40
SAVE_COUNT = 15
WHEEL_TURN_COUNT = 30
DURATION_S = 10.0
PAGE_COUNT = 4
STAMP_EXPRESSION = "() => window.linkwright.stamp"
SETTLING_S = 3.0
"""The seconds until a page has determined its drawing resolution."""
CORE_UNIT = "% of a core"


def make_row(what: str, values: list[float], unit: str, target: str = "") -> Row:
    """Return a row with the median, the minimum and the maximum."""
    return Row(f"{what} ({min(values):.3g} to {max(values):.3g})", statistics.median(values), unit, target)


def measure_start_up(browser: Browser, *words: str, answer: str = "0.7 s", drawn: str = "2.5 s") -> list[Row]:
    """Measure the time from the command to the first response and to the drawn robot.

    The time from the opening of a page is measured as well.
    """
    answers, measure_robots, openings = [], [], []
    size = 0.0
    for _ in range(RUN_COUNT):
        with start_linkwright(*words) as (process, port, begin):
            answers.append(wait_for_response(port, begin))
            url = read_viewer_url(process)
            with open_page(browser, url) as page:
                measure_robots.append(time.perf_counter() - begin)
                size = measure_scripts(page)
            begin = time.perf_counter()
            with open_page(browser, url):
                openings.append(time.perf_counter() - begin)
    return [
        make_row(f"`{words[0]}`, command to first HTTP answer", answers, "s", answer),
        make_row(f"`{words[0]}`, command to robot drawn", measure_robots, "s", drawn),
        make_row("page opened to robot drawn", openings, "s", "2 s"),
        Row("scripts and styles loaded until then", size, "KiB"),
    ]


def measure_latencies(browser: Browser, package: Path) -> list[Row]:
    """Measure the latency from a slider, and from a saved file."""
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "model.urdf"
        shutil.copy(package / "urdf" / "mbot_base.urdf", model)
        with (
            start_linkwright("view", str(model)) as (process, _, _),
            open_page(browser, read_viewer_url(process)) as page,
        ):
            known, drawn = measure_slider_latency(page, MOVE_COUNT)
            saved = measure_save_latency(page, model, SAVE_COUNT)
    return [
        make_row("slider moved to frames in the page", known, "ms", "50 ms"),
        make_row("slider moved to drawn frame", drawn, "ms", "100 ms"),
        make_row("file saved to frames in the page", saved, "ms", "150 ms"),
    ]


def measure_robots(browser: PlainBrowser, links: int, *, server: str, page_rate: str) -> list[Row]:
    """Measure a robot of boxes, all of whose joints move at 30 Hz."""
    with tempfile.TemporaryDirectory() as folder:
        launch = write_sweep(Path(folder), links, 30)
        return measure_moving_robot(
            browser, launch, f"{links} links moving at 30 Hz", server=server, page_rate=page_rate
        )


def measure_meshes(browser: PlainBrowser) -> list[Row]:
    """Measure a moving arm whose shapes are meshes."""
    with tempfile.TemporaryDirectory() as folder:
        launch = write_arm_sweep(Path(folder), 30)
        what = "an arm of 96 000 triangles moving at 30 Hz"
        return measure_moving_robot(browser, launch, what, server="", page_rate="30", peer="arm")


def measure_viser(browser: PlainBrowser, scene: str) -> tuple[dict[str, float | None], dict[str, float | None]]:
    """Return the load of viser's server and its page's frame rate, for one of `viser_scenes`.

    The browser is the same.
    """
    if not scene:
        return {}, {}
    if peers.get_version("viser") is None:
        return {"viser": None}, {"viser": None}
    with (
        show_with_viser(scene) as process,
        open_plain_page(browser, read_viewer_url(process), "window.framesWithDrawing > 5", COUNT_FRAMES) as page,
    ):
        time.sleep(SETTLING_S)
        core = CoreShare(process)
        rate = measure_rate(count_drawing_frames, page, DURATION_S)
        return {"viser": core.share}, {"viser": rate}


def measure_moving_robot(
    browser: PlainBrowser, launch: Path, what: str, *, server: str, page_rate: str, peer: str = ""
) -> list[Row]:
    """Measure the load of the server and the frame rate while the joints of a launch file move."""
    shares, rates = measure_viser(browser, peer)
    with ExitStack() as stack:
        process, _, _ = stack.enter_context(start_linkwright("launch", str(launch)))
        page = stack.enter_context(open_plain_page(browser, read_viewer_url(process)))
        time.sleep(SETTLING_S)
        core = CoreShare(process)
        rate = measure_rate(count_frames, page, DURATION_S)
        share = core.share
    return [
        Row(f"server, {what}", share, CORE_UNIT, server, shares),
        Row(f"page, {what}, frames drawn", rate, "1/s", page_rate, rates),
    ]


def measure_many_pages(browser: PlainBrowser, links: int) -> list[Row]:
    """Measure several pages at once, which all receive the newest transforms at any frame rate."""
    what = f"{PAGE_COUNT} browsers at once, {links} links at 30 Hz"
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        launch = write_sweep(Path(folder), links, 30)
        process, _, _ = stack.enter_context(start_linkwright("launch", str(launch)))
        url = read_viewer_url(process)
        pages = [stack.enter_context(open_plain_page(browser, url)) for _ in range(PAGE_COUNT)]
        time.sleep(1)
        core = CoreShare(process)
        rate = measure_rate(count_frames, pages[0], DURATION_S)
        share = core.share
        age = measure_transform_age(pages, 20)
    return [
        Row(f"server, {what}", share, CORE_UNIT),
        Row(f"page, {what}, frames drawn by each", rate, "1/s", "25"),
        Row(f"age of the transforms in the slowest page, {what}", age, "ms"),
    ]


def measure_data(
    browser: PlainBrowser, scene: str, what: str, *, server: str = "", page_rate: str = "", peer: str = ""
) -> list[Row]:
    """Measure a display of data: the server's load, the frame rate, and the mouse's latency."""
    shares, rates = measure_viser(browser, peer)
    with (
        show_scene(scene) as process,
        open_plain_page(browser, read_viewer_url(process), "window.linkwright?.framesDrawn > 5") as page,
    ):
        time.sleep(2)
        core = CoreShare(process)
        rate = measure_rate(count_frames, page, DURATION_S)
        share = core.share
        turns = measure_wheel_latency(page, WHEEL_TURN_COUNT)
    return [
        Row(f"server, {what}", share, CORE_UNIT, server, shares),
        Row(f"page, {what}, frames drawn", rate, "1/s", page_rate, rates),
        make_row(f"page, {what}, wheel to drawn frame", turns, "ms"),
    ]


def measure_images(browser: PlainBrowser) -> list[Row]:
    """Measure images in a panel, for which the scene is not drawn."""
    what = "image 640x480 at 30 Hz"
    shown = "window.linkwright?.displays[0]?.drawn?.images > 5"
    with show_scene("image") as process, open_plain_page(browser, read_viewer_url(process), shown) as page:
        time.sleep(2)
        core = CoreShare(process)
        rate = measure_rate(count_images, page, DURATION_S)
        share = core.share
    return [Row(f"server, {what}", share, CORE_UNIT), Row(f"page, {what}, shown", rate, "1/s", "30")]


def measure_demo(browser: PlainBrowser, description: Path) -> list[Row]:
    """Measure the speed of world and page in `make demo`.

    A robot with laser and camera moves in a simulated world.
    """
    words = ("sim", "playground", str(description / "urdf" / "mbot_gazebo.xacro"), "laser:=true", "camera:=true")
    with start_linkwright(*words) as (process, _, _), open_plain_page(browser, read_viewer_url(process)) as page:
        time.sleep(SETTLING_S)
        begin = page.evaluate(STAMP_EXPRESSION)
        rate = measure_rate(count_frames, page, DURATION_S)
        passed = page.evaluate(STAMP_EXPRESSION) - begin
    return [
        Row("page, `make demo`, frames drawn", rate, "1/s", "20"),
        Row("simulated time in a second, `make demo` with its page", passed / DURATION_S, "s", "1"),
    ]


def measure_many_displays(browser: Browser, model: Path, count: int = 240) -> Row:
    """Measure the server's processor time until many displays without publishers are drawn."""
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
        for _ in range(RUN_COUNT):
            with start_linkwright("view", str(model), "-d", str(file)) as (process, _, _):
                ready = f"window.linkwright?.displays.length === {count} && window.linkwright.settled"
                with open_page(browser, read_viewer_url(process), ready):
                    times = psutil.Process(process.pid).cpu_times()
                    used.append(times.user + times.system)
    return make_row(f"server, opening a .rviz of {count} displays, processor time", used, "s", "1.5 s")


def measure_rest(browser: Browser, model: Path) -> list[Row]:
    """Measure a robot at rest, whose nodes continue to publish while the page draws nothing."""
    with start_linkwright("view", str(model)) as (process, _, _), ExitStack() as stack:
        url = read_viewer_url(process)
        time.sleep(3)
        core = CoreShare(process)
        time.sleep(5)
        alone = core.share
        page = stack.enter_context(open_page(browser, url))
        page.set_viewport_size({"width": 1600, "height": 1200})
        open_every_panel(page)
        time.sleep(3)
        old_frames, core = count_frames(page), CoreShare(process)
        time.sleep(5)
        drawn, share = count_frames(page) - old_frames, core.share
    return [
        Row("page, nothing moves, all panels open, frames drawn in 5 s", drawn, "", "0"),
        Row("server, nothing moves, nobody watches", alone, CORE_UNIT),
        Row("server, nothing moves, all panels open, more than that", share - alone, CORE_UNIT, "0.5"),
    ]


def measure_recordings(browser: PlainBrowser) -> list[Row]:
    """Measure a click on a large recording's timeline, until frames, scan and image are drawn."""
    table = []
    for storage in STORAGES:
        size, times = measure_seeks(browser, storage)
        table.append(make_row(f"seek in {size:.3g} GB ({storage}) to drawn frame and image", times, "ms", "500 ms"))
    return table


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    package = PackageFinder().share("my_robot_description")
    with run_chromium() as browser:
        model = package / "urdf" / "mbot_base.urdf"
        starts = [
            *measure_start_up(browser, "view", str(model), answer="0.2 s", drawn="0.7 s"),
            *measure_start_up(browser, "launch", str(package / "launch" / "display.launch.py")),
            *measure_latencies(browser, package),
        ]
        still = [*measure_rest(browser, model), measure_many_displays(browser, model)]
    with run_plain_chromium() as plain:
        return [
            *starts,
            *measure_robots(plain, 12, server="3", page_rate="30"),
            *measure_robots(plain, 500, server="5", page_rate="30"),
            *measure_meshes(plain),
            *measure_many_pages(plain, 12),
            *measure_data(plain, "points", "100 000 points at 10 Hz", page_rate="10", peer="points"),
            *measure_data(plain, "markers", "1000 markers at 10 Hz", page_rate="10"),
            *measure_images(plain),
            *measure_demo(plain, package),
            *measure_data(plain, "scan", "500 links at 30 Hz and a scan"),
            *measure_recordings(plain),
            *still,
        ]
