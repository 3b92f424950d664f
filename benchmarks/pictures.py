"""Measure images of 1 MB between nodes of Linkwright and of real ROS 2 on Fast DDS.

The figures are the received images, and whether a reader hangs. ``python -m benchmarks.pictures``, after ``make
.build/ros/.ready`` and ``make .build/ros-kilted/.ready ROS=kilted``; ``--loops 3`` keeps three further cores busy.
Milliseconds are processor times per image. The background is in `docs/decisions/0095-large-messages-to-fast-dds.md` and
`0104-large-messages-packet-by-packet.md`. Both sides of a pair run this program, each with its own rclpy.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

IMAGE_BYTES = 1_000_000
START_TIMEOUT_S = 60.0
HANG_TIMEOUT_S = 5.0
"""The seconds without an image, while images are published, after which a reader counts as hung."""

PAIRS = [
    ("linkwright", "linkwright"),
    ("linkwright", "jazzy"),
    ("linkwright", "kilted"),
    ("jazzy", "linkwright"),
    ("kilted", "linkwright"),
    ("jazzy", "jazzy"),
]


def make_profile(reliable: bool, depth: int) -> Any:
    """Return the quality of service of both sides."""
    from rclpy.qos import QoSProfile, ReliabilityPolicy

    return QoSProfile(
        depth=depth, reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT
    )


def publish(reliable: bool, depth: int, rate: float, seconds: float) -> None:
    """Publish images from the first subscription on, and print their number."""
    import rclpy
    from sensor_msgs.msg import Image

    rclpy.init()
    node = rclpy.create_node("pictures")
    publisher = node.create_publisher(Image, "/picture", make_profile(reliable, depth))
    image = Image(height=1, width=IMAGE_BYTES, encoding="mono8", step=IMAGE_BYTES, data=bytes(IMAGE_BYTES))
    until = time.monotonic() + START_TIMEOUT_S
    while not publisher.get_subscription_count() and time.monotonic() < until:
        rclpy.spin_once(node, timeout_sec=0.1)
    time.sleep(1.0)  # time for both sides to discover each other
    began, count, cpu = time.monotonic(), 0, time.process_time()
    while time.monotonic() < began + seconds:
        publisher.publish(image)
        count += 1
        while (left := began + count / rate - time.monotonic()) > 0:
            rclpy.spin_once(node, timeout_sec=left)
    time.sleep(1.0)  # lost images are sent again
    print(count, time.process_time() - cpu, flush=True)
    os._exit(0)


def subscribe(reliable: bool, depth: int, counter: Path) -> None:
    """Write the number of received images and the processor time to a file.

    A reader that hangs could not reply.
    """
    import rclpy
    from sensor_msgs.msg import Image

    received_count, cpu = 0, 0.0

    def on_picture(_: Image) -> None:
        nonlocal received_count, cpu
        cpu = cpu or time.process_time()
        received_count += 1
        counter.write_text(f"{received_count} {time.process_time() - cpu}")

    rclpy.init()
    node = rclpy.create_node("looking")
    node.create_subscription(Image, "/picture", on_picture, make_profile(reliable, depth))
    rclpy.spin(node)


def start_program(side: str, *words: str) -> subprocess.Popen[str]:
    """Start one side of a pair."""
    variables = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    if side == "linkwright":
        from linkwright.standins.process import create_environment

        python = sys.executable
        variables |= {"PYTHONPATH": create_environment()["PYTHONPATH"], "ROS_DISTRO": "jazzy"}
    else:
        folder = Path(".build/ros" if side == "jazzy" else ".build/ros-kilted").absolute()
        python = str(folder / "bin/python")
        variables |= {"RMW_IMPLEMENTATION": "rmw_fastrtps_cpp", "AMENT_PREFIX_PATH": str(folder)}
    return subprocess.Popen([python, __file__, *words], env=variables, stdout=subprocess.PIPE, text=True)


def measure(pair: tuple[str, str], reliable: bool, depth: int, rate: float, seconds: float) -> dict[str, Any]:
    """Return the numbers of sent and received images, their cost, and whether the reader hung."""
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as ends:
        counter = Path(folder) / "came"
        counter.write_text("0 0")
        kind = "reliable" if reliable else "best-effort"
        reader = start_program(pair[1], "subscribe", kind, str(max(depth, 5)), str(counter))
        ends.callback(reader.kill)
        writer = start_program(pair[0], "publish", kind, str(depth), str(rate), str(seconds))
        ends.callback(writer.kill)
        last_received, since, hung = "0 0", time.monotonic(), False
        while writer.poll() is None:
            time.sleep(0.2)  # a reader that hangs cannot report, so its file is polled
            received = counter.read_text() or last_received
            if received != last_received:
                last_received, since = received, time.monotonic()
            hung = hung or (last_received != "0 0" and time.monotonic() - since > HANG_TIMEOUT_S)
        sent, sending = ((writer.stdout.read() if writer.stdout else "") or "0 0").split()
        received, receiving = counter.read_text().split()
    return {
        "pair": " to ".join(pair),
        "kind": kind,
        "depth": depth,
        "rate": rate,
        "sent": int(sent),
        "came": int(received),
        "sender_ms": round(1e3 * float(sending) / max(int(sent), 1), 2),
        "receiver_ms": round(1e3 * float(receiving) / max(int(received), 1), 2),
        "hung": hung,
    }


def main() -> None:
    """Measure each pair, reliable and best effort, with depths and rates."""
    if sys.argv[1:2] == ["publish"]:
        publish(sys.argv[2] == "reliable", int(sys.argv[3]), float(sys.argv[4]), float(sys.argv[5]))
    if sys.argv[1:2] == ["subscribe"]:
        subscribe(sys.argv[2] == "reliable", int(sys.argv[3]), Path(sys.argv[4]))
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--loops", type=int, default=0, help="busy loops beside it")
    options.add_argument("--seconds", type=float, default=6.0, help="of each measurement")
    chosen = options.parse_args()
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(chosen.loops)]
    try:
        for pair in PAIRS:
            for reliable, depth in ((True, 1), (True, 5), (True, 10), (False, 5)):
                for rate in (10.0, 30.0, 100.0):
                    print(json.dumps(measure(pair, reliable, depth, rate, chosen.seconds)), flush=True)
    finally:
        for loop in loops:
            loop.kill()


if __name__ == "__main__":
    main()
