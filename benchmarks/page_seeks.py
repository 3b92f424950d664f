"""Seeks in a large recording: from a click on the timeline to the frame and the image of that time."""

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

from benchmarks.page_programs import started, viewer_url, watched
from benchmarks.plain_browser import PlainBrowser, PlainPage
from linkwright.bag import BagWriter
from linkwright.graph import DEFAULT_QOS
from linkwright.messages import TFMessage, TransformBatch, get_message, serialize

GIGABYTES = 10.0
"""Of the recording, with images, transforms and scans; half of what is free where that is less."""
SEEKS = 20

_START = 1_700_000_000
_SECOND = 1_000_000_000
_RATE = 30
_WIDTH, _HEIGHT = 640, 480
_IMAGE = 3 * _WIDTH * _HEIGHT
_STEPS = 16
"""Shades of an image; two seconds that follow one another differ by one."""
_SHOWN = "window.linkwright?.frames.tip && window.linkwright.displays.some(({ drawn }) => drawn?.images > 1)"

_PAUSE = "() => document.querySelector('button[aria-label=\"Pause (Space)\"]')?.click()"
_TRACK = "() => document.querySelector('.timeline-track').getBoundingClientRect().toJSON()"

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


def seeks(browser: PlainBrowser, storage: str) -> tuple[float, list[float]]:
    """Milliseconds of clicks at random places of a recording that stands still and is in no cache; before, its GB."""
    size = min(GIGABYTES, shutil.disk_usage(tempfile.gettempdir()).free / 2e9)
    with (
        _recorded(storage, size) as (file, length),
        started("view", str(file)) as (process, _, _),
        watched(browser, viewer_url(process), _SHOWN) as page,
    ):
        page.evaluate(_PAUSE)
        page.until("!window.linkwright.timeline.playing")
        page.evaluate(_WATCH_CLICKS)
        chance = random.Random(14)
        return size, [_seek(page, file, length, chance.uniform(0.02, 0.98)) for _ in range(SEEKS)]


def _seek(page: PlainPage, file: Path, length: float, part: float) -> float:
    _forget(file)
    box: dict[str, float] = page.evaluate(_TRACK)
    page.evaluate(f"() => {{ window.target = {part * length}; window.took = null; }}")
    page.click(box["x"] + part * box["width"], box["y"] + box["height"] / 2)
    took: float = page.until("window.took")
    return took


def _forget(file: Path) -> None:
    """Drop a file from the page cache, so that it is read from the disk again."""
    with file.open("rb") as opened:
        os.fsync(opened.fileno())
        os.posix_fadvise(opened.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


@contextmanager
def _recorded(storage: str, gigabytes: float) -> Iterator[tuple[Path, float]]:
    """A recording in one file, and its seconds: a frame whose x is the time, images shaded by the second, scans."""
    image: Any = get_message("sensor_msgs/msg/Image")
    scan: Any = get_message("sensor_msgs/msg/LaserScan")
    count = int(gigabytes * 1e9 / _IMAGE)
    with tempfile.TemporaryDirectory() as folder:
        with BagWriter(Path(folder) / "drive", storage) as writer:
            writer.add_topic("/tf", "tf2_msgs/msg/TFMessage", [DEFAULT_QOS])
            writer.add_topic("/camera", "sensor_msgs/msg/Image", [DEFAULT_QOS])
            writer.add_topic("/scan", "sensor_msgs/msg/LaserScan", [DEFAULT_QOS])
            for number in range(count):
                stamp = _START * _SECOND + number * _SECOND // _RATE
                at = number / _RATE
                batch = TransformBatch(("base",), ("tip",), stamp, np.array([[at, 0, 0, 0, 0, 0, 1.0]]))
                writer.write("/tf", stamp, serialize(TFMessage(batch=batch)))
                picture = image(width=_WIDTH, height=_HEIGHT, encoding="rgb8", step=3 * _WIDTH)
                picture.header.frame_id = "tip"
                picture.header.stamp.sec, picture.header.stamp.nanosec = divmod(stamp, _SECOND)
                picture.data = bytes([16 * (int(at + 0.02) % _STEPS)]) * _IMAGE
                writer.write("/camera", stamp, serialize(picture))
                if number % 3 == 0:
                    ranges = np.full(720, 2.0 + at % 5, dtype=np.float32)
                    seen = scan(angle_min=-3.14, angle_max=3.14, angle_increment=0.0087, range_max=30.0, ranges=ranges)
                    seen.header = picture.header
                    writer.write("/scan", stamp, serialize(seen))
        (file,) = [path for path in (Path(folder) / "drive").iterdir() if path.suffix in (".mcap", ".db3")]
        yield file, (count - 1) / _RATE
