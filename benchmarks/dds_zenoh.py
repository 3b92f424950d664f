"""Joint states through `zenoh-ros2-sdk`, which needs a router: three processes, started by `bench_dds`.

It runs in the Python of the peers: ``python dds_zenoh.py router|send|receive PORT DESCRIPTION SECONDS``, where the
description is a JSON file with the type's definition and hash.
"""

from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path
from typing import Any

TYPE = "sensor_msgs/msg/JointState"
JOINTS = 12


def route(port: int) -> None:
    """Pass messages on until standard input is closed."""
    import zenoh

    settings = zenoh.Config()
    settings.insert_json5("mode", '"router"')
    settings.insert_json5("listen/endpoints", f'["tcp/127.0.0.1:{port}"]')
    with zenoh.open(settings):
        print("ready", flush=True)
        sys.stdin.read()


def send(port: int, definition: str, hashed: str, seconds: float) -> dict[str, float]:
    """Publish as fast as it goes."""
    import numpy as np
    from rosbags.typesys import Stores, get_typestore
    from zenoh_ros2_sdk import ROS2Publisher

    types = get_typestore(Stores.ROS2_HUMBLE).types
    header = types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](0, 0), "base_link")
    publisher = ROS2Publisher("/measured", TYPE, router_port=port, msg_definition=definition, type_hash=hashed)
    time.sleep(1.0)
    names, values = [f"joint_{number}" for number in range(JOINTS)], np.full(JOINTS, 0.1)
    count, begin, cpu = 0, time.perf_counter(), time.process_time()
    while time.perf_counter() - begin < seconds:
        publisher.publish(header=header, name=names, position=values, velocity=values, effort=values)
        count += 1
    passed = time.perf_counter() - begin
    return {"count": count, "seconds": passed, "cores": (time.process_time() - cpu) / passed}


def receive(port: int, definition: str, hashed: str, seconds: float) -> dict[str, float]:
    """Take until no more comes."""
    from zenoh_ros2_sdk import ROS2Subscriber

    count, first, last, cpu = 0, 0.0, 0.0, 0.0

    def received(_message: Any) -> None:
        nonlocal count, first, last, cpu
        last = time.perf_counter()
        if not count:
            first, cpu = last, time.process_time()
        count += 1

    subscriber = ROS2Subscriber(
        "/measured", TYPE, received, router_port=port, msg_definition=definition, type_hash=hashed
    )
    print("ready", flush=True)
    limit = time.monotonic() + seconds + 20
    while time.monotonic() < limit and not (count and time.perf_counter() - last > 1.0):
        time.sleep(0.2)
    del subscriber
    passed = max(last - first, 1e-9)
    return {"count": count, "seconds": passed, "cores": (time.process_time() - cpu) / passed}


if __name__ == "__main__":
    side, chosen_port = sys.argv[1], int(sys.argv[2])
    if side == "router":
        route(chosen_port)
    else:
        text, type_hash = json.loads(Path(sys.argv[3]).read_text(encoding="utf-8"))
        result = (send if side == "send" else receive)(chosen_port, text, type_hash, float(sys.argv[4]))
        print(json.dumps(result), flush=True)
        os._exit(0)  # the session's threads would go on
