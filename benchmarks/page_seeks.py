"""Measure seeks in a large recording, from a click on the timeline to frame and image."""

from __future__ import annotations

import os
import random
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.page_programs import open_plain_page, read_viewer_url, start_linkwright
from benchmarks.plain_browser import PlainBrowser, PlainPage
from linkwright.bag import BagWriter
from linkwright.graph import DEFAULT_QOS
from linkwright.messages import TFMessage, TransformBatch, get_message, serialize

MAX_GIGABYTES = 10.0
"""The size of the recording with images, transforms and scans; at most half of the free disk space."""
SEEK_COUNT = 20

_START_S = 1_700_000_000
_SECOND_NS = 1_000_000_000
_RATE_HZ = 30
_WIDTH, _HEIGHT = 640, 480
_IMAGE_BYTES = 3 * _WIDTH * _HEIGHT
_SHADE_COUNT = 16
"""The number of shades of an image; the shades of consecutive seconds differ by one."""
_SHOWN_CONDITION = "window.linkwright?.frames.tip && window.linkwright.displays.some(({ drawn }) => drawn?.images > 1)"

_PAUSE_BUTTON_CODE = "() => document.querySelector('button[aria-label=\"Pause (Space)\"]')?.click()"
_TRACK_CODE = "() => document.querySelector('.timeline-track').getBoundingClientRect().toJSON()"

_WATCH_CLICKS = """
() => {
  const shade = () => window.linkwright.displays.find(({ drawn }) => drawn?.images > 0)?.drawn.middle[0];
  addEventListener("pointerdown", async (event) => {
    const { target } = window;
    let frames = window.linkwright.framesDrawn;
    let known = 0;
    while (performance.now() - event.timeStamp < 30000) {
      const at = window.linkwright.frames.tip?.position[0] ?? -1;
      const isThere = Math.abs(at - target) < 2 && Math.abs((shade() ?? -99) - 16 * (Math.floor(at + 0.02) % 16)) < 4;
      if (!isThere) frames = window.linkwright.framesDrawn;
      else if (window.linkwright.framesDrawn > frames) break;
      await new Promise((next) => setTimeout(next, 1));
    }
    window.took = performance.now() - event.timeStamp;
  }, { capture: true, passive: true });
}
"""


def measure_seeks(browser: PlainBrowser, storage: str) -> tuple[float, list[float]]:
    """Return the GB of a paused, uncached recording, and the ms of clicks at random places."""
    size = min(MAX_GIGABYTES, shutil.disk_usage(tempfile.gettempdir()).free / 2e9)
    with (
        _create_recording(storage, size) as (file, length),
        start_linkwright("view", str(file)) as (process, _, _),
        open_plain_page(browser, read_viewer_url(process), _SHOWN_CONDITION) as page,
    ):
        page.evaluate(_PAUSE_BUTTON_CODE)
        page.wait_until("!window.linkwright.timeline.playing")
        page.evaluate(_WATCH_CLICKS)
        chance = random.Random(14)
        return size, [_measure_seek(page, file, length, chance.uniform(0.02, 0.98)) for _ in range(SEEK_COUNT)]


def _measure_seek(page: PlainPage, file: Path, length: float, part: float) -> float:
    _drop_from_cache(file)
    box: dict[str, float] = page.evaluate(_TRACK_CODE)
    page.evaluate(f"() => {{ window.target = {part * length}; window.took = null; }}")
    page.click(box["x"] + part * box["width"], box["y"] + box["height"] / 2)
    took: float = page.wait_until("window.took")
    return took


def _drop_from_cache(file: Path) -> None:
    """Drop a file from the page cache, so that it is read from the disk again."""
    with file.open("rb") as opened:
        os.fsync(opened.fileno())
        os.posix_fadvise(opened.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


@contextmanager
def _create_recording(storage: str, gigabytes: float) -> Iterator[tuple[Path, float]]:
    """Yield a recording in one file, and its duration in s.

    It has a frame whose x is the time, images whose shade is the second, and scans.
    """
    image: Any = get_message("sensor_msgs/msg/Image")
    scan: Any = get_message("sensor_msgs/msg/LaserScan")
    count = int(gigabytes * 1e9 / _IMAGE_BYTES)
    with tempfile.TemporaryDirectory() as folder:
        with BagWriter(Path(folder) / "drive", storage) as writer:
            writer.add_topic("/tf", "tf2_msgs/msg/TFMessage", [DEFAULT_QOS])
            writer.add_topic("/camera", "sensor_msgs/msg/Image", [DEFAULT_QOS])
            writer.add_topic("/scan", "sensor_msgs/msg/LaserScan", [DEFAULT_QOS])
            for number in range(count):
                stamp = _START_S * _SECOND_NS + number * _SECOND_NS // _RATE_HZ
                time_s = number / _RATE_HZ
                batch = TransformBatch(("base",), ("tip",), stamp, np.array([[time_s, 0, 0, 0, 0, 0, 1.0]]))
                writer.write("/tf", stamp, serialize(TFMessage(batch=batch)))
                picture = image(width=_WIDTH, height=_HEIGHT, encoding="rgb8", step=3 * _WIDTH)
                picture.header.frame_id = "tip"
                picture.header.stamp.sec, picture.header.stamp.nanosec = divmod(stamp, _SECOND_NS)
                picture.data = bytes([16 * (int(time_s + 0.02) % _SHADE_COUNT)]) * _IMAGE_BYTES
                writer.write("/camera", stamp, serialize(picture))
                if number % 3 == 0:
                    ranges = np.full(720, 2.0 + time_s % 5, dtype=np.float32)
                    laser_scan = scan(
                        angle_min=-3.14, angle_max=3.14, angle_increment=0.0087, range_max=30.0, ranges=ranges
                    )
                    laser_scan.header = picture.header
                    writer.write("/scan", stamp, serialize(laser_scan))
        (file,) = [path for path in (Path(folder) / "drive").iterdir() if path.suffix in (".mcap", ".db3")]
        yield file, (count - 1) / _RATE_HZ
