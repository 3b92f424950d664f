"""Measure detectors and their node: the processor time per image, and images per second.

Run it with ``python -m benchmarks vision``. Times are processor times of all threads, so other programs have little
influence. Images per second are counted at ``/yolo/detections`` of ``my_robot_vision detect.launch.py``, and are only
meaningful on a quiet machine. The processor time per image of that launch is meaningful on every machine: 30 images per
second on two processors leave 66 ms.
"""

from __future__ import annotations

import asyncio
import os
import signal
import statistics
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.measure import LINKWRIGHT, Row
from linkwright.graph import Graph
from linkwright.images import RangeFinder, Unpacker, decode_image
from linkwright.messages import get_message
from linkwright.vision.detector import Limits
from linkwright.vision.detectors.drawing import draw_detections
from linkwright.vision.detectors.library import load_opencv
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.registry import make_detector
from linkwright.vision.nodes.detection_messages import image_message, vision_message
from linkwright.wire.dds import join

MODELS = ("colors", "things")
_IMAGE_COUNT = 60
_DURATION_S = 20.0
_START_TIMEOUT_S = 120.0
_DOMAIN = "187"
_IMAGE_SHAPE = (480, 640)


def rows() -> list[Row]:
    """Measure one image in this process, then the launch file in a separate process."""
    return [*_measure_one_image(), *(row for model in MODELS for row in _measure_launch(model))]


def _measure_one_image() -> Iterator[Row]:
    image = _make_scene()
    message = image_message(get_message("std_msgs/msg/Header")(frame_id="camera"), image)
    unpacker, ranges = Unpacker(), RangeFinder()
    for encoding in ("rgb8", "bgr8"):
        message.encoding = encoding
        milliseconds = _measure_milliseconds(lambda: decode_image(unpacker.image(message, "raw"), ranges).rgb())
        yield Row(f"a picture of {encoding} taken from its message", milliseconds, "ms")
    for model in MODELS:
        detector = make_detector(model, DetectorOptions())
        detections = detector.detect(image, Limits())
        yield Row(f"{model}: found in it", _measure_milliseconds(partial(detector.detect, image, Limits())), "ms", "33")
        yield Row(
            f"{model}: {len(detections)} detections as a message",
            _measure_milliseconds(partial(vision_message, message.header, detections)),
            "ms",
        )
        yield Row(
            f"{model}: the picture with boxes", _measure_milliseconds(partial(draw_detections, image, detections)), "ms"
        )


def _make_scene() -> NDArray[np.uint8]:
    """Return a constant image of plain objects on a floor, with camera noise."""
    cv2 = load_opencv()
    image = np.full((*_IMAGE_SHAPE, 3), 150, np.uint8)
    image[: _IMAGE_SHAPE[0] // 2] = (150, 175, 205)
    cv2.circle(image, (200, 300), 50, (200, 20, 30), -1)
    cv2.rectangle(image, (400, 250), (480, 330), (220, 120, 20), -1)
    cv2.circle(image, (550, 300), 30, (20, 160, 40), -1)
    noise = np.random.default_rng(1).normal(0.0, 2.0, image.shape)
    noisy: NDArray[np.uint8] = np.clip(image + noise, 0, 255).astype(np.uint8)
    return noisy


def _measure_milliseconds(call: Callable[[], object]) -> float:
    """Return the processor time of one call in ms, the median of many."""
    call()
    times = []
    for _ in range(_IMAGE_COUNT):
        began = time.process_time()
        call()
        times.append(time.process_time() - began)
    return statistics.median(times) * 1000.0


def _measure_launch(model: str) -> Iterator[Row]:
    with _start_launch(model) as process:
        images, seconds, processor, share = asyncio.run(_count_detections(process.pid))
    about = f"{model}, beside the simulation:"
    yield Row(f"{about} detections a second", images / seconds, "/s", "30")
    yield Row(f"{about} pictures of the camera with detections", share, "%")
    yield Row(f"{about} the processor's time of all for each", 1000.0 * processor / images, "ms", "66")


@contextmanager
def _start_launch(model: str) -> Iterator[subprocess.Popen[bytes]]:
    words = [LINKWRIGHT, "launch", "my_robot_vision", "detect.launch.py", f"model:={model}", "--no-open"]
    process = subprocess.Popen(
        words,
        env={**os.environ, "ROS_DOMAIN_ID": _DOMAIN},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()


async def _count_detections(pid: int) -> tuple[int, float, float, float]:
    """Return the number of detections, the duration, the CPU time, and the share with detections.

    The number of images follows from their stamps, which are one period apart.
    """
    stamps: list[int] = []
    os.environ["ROS_DOMAIN_ID"] = _DOMAIN
    graph = Graph()
    join(graph)
    try:
        node = graph.create_node("benchmark")

        def receive(message: Any) -> None:
            stamps.append(message.header.stamp.nanoseconds)

        node.create_subscription("vision_msgs/msg/Detection2DArray", "/yolo/detections", receive, 10)
        deadline = time.monotonic() + _START_TIMEOUT_S
        while len(stamps) < 30:
            if time.monotonic() > deadline:
                raise RuntimeError("no detections came: start the launch file by hand and see what it says")
            await asyncio.sleep(0.1)
        stamps.clear()
        start_processor_s, began = _get_processor_seconds(pid), time.monotonic()
        await asyncio.sleep(_DURATION_S)
        processor_s, seconds = _get_processor_seconds(pid) - start_processor_s, time.monotonic() - began
        gaps = np.diff(stamps)
        share = 100.0 * len(gaps) * float(gaps.min()) / float(gaps.sum())
        return len(stamps), seconds, processor_s, share
    finally:
        await graph.close()


def _get_processor_seconds(pid: int) -> float:
    """Return the user and system time of all threads of a process."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
