"""The peer of `dds_sides` with zenoh-ros2-sdk, which sends CDR of rosbags over Zenoh.

No router is needed: the receiver listens on a port, and the sender connects to it. Message definitions and type hashes
are given, because the SDK would fetch them from the network.
"""

from __future__ import annotations

import dataclasses
import os
import time
from typing import Any

from benchmarks import peers
from benchmarks.dds_sides import (
    HEIGHT,
    JOINT_COUNT,
    TOPIC,
    TRANSFORM_COUNT,
    WIDTH,
    Result,
    compute_median_age,
    get_age,
    send_paced,
)
from linkwright.messages import type_hash
from linkwright.messages.schema_text import schema_of

TYPES = {
    "joints": "sensor_msgs/msg/JointState",
    "transforms": "tf2_msgs/msg/TFMessage",
    "objects": "tf2_msgs/msg/TFMessage",
    "images": "sensor_msgs/msg/Image",
}
PORT = 17447


def _load_sdk(kind: str, *, listens: bool) -> tuple[Any, dict[str, Any]]:
    """Return the SDK, and its arguments for a publisher or a subscriber of a kind."""
    ours, none = f'["tcp/127.0.0.1:{PORT}"]', "[]"
    listen, connect = (ours, none) if listens else (none, ours)
    os.environ["ZENOH_CONFIG_OVERRIDE"] = f"listen/endpoints={listen};connect/endpoints={connect}"
    sdk = peers.load_module("zenoh_ros2_sdk")
    if sdk is None:
        raise SystemExit("zenoh-ros2-sdk is not installed")
    name = TYPES[kind]
    arguments = {"topic": TOPIC, "msg_type": name, "msg_definition": schema_of(name), "type_hash": type_hash(name)}
    return sdk, arguments


def make_fields(kind: str, types: Any) -> dict[str, Any]:
    """Return the fields of a message with the same content as `dds_sides.ours`."""
    import numpy as np

    stamp = types["builtin_interfaces/msg/Time"](sec=0, nanosec=0)
    header = types["std_msgs/msg/Header"](stamp=stamp, frame_id="base_link")
    if kind == "joints":
        names = [f"joint_{number}" for number in range(JOINT_COUNT)]
        values = [np.full(JOINT_COUNT, value) for value in (0.1, 0.2, 0.3)]
        return dict(zip(("header", "name", "position", "velocity", "effort"), (header, names, *values), strict=True))
    if kind == "images":
        sizes = {"height": HEIGHT, "width": WIDTH, "encoding": "rgb8", "is_bigendian": 0, "step": 3 * WIDTH}
        return {"header": header, **sizes, "data": np.zeros(3 * WIDTH * HEIGHT, dtype=np.uint8)}
    translation = types["geometry_msgs/msg/Vector3"](x=0.0, y=0.0, z=0.0)
    rotation = types["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=0.0, w=1.0)
    transform = types["geometry_msgs/msg/Transform"](translation=translation, rotation=rotation)
    stamped = types["geometry_msgs/msg/TransformStamped"](header=header, child_frame_id="", transform=transform)
    links = [dataclasses.replace(stamped, child_frame_id=f"link_{number}") for number in range(TRANSFORM_COUNT)]
    return {"transforms": links}


def send(kind: str, seconds: float, rate: float) -> Result:
    """Publish messages at a rate for some seconds."""
    sdk, arguments = _load_sdk(kind, listens=False)
    publisher = sdk.ROS2Publisher(**arguments)
    message = make_fields(kind, publisher.session_mgr.store.types)
    limit = time.monotonic() + 10.0
    while not publisher.pub.matching_status.matching and time.monotonic() < limit:
        time.sleep(0.01)

    def publish() -> None:
        stamp = (message["header"] if "header" in message else message["transforms"][0].header).stamp
        stamp.sec, stamp.nanosec = divmod(time.time_ns(), 1_000_000_000)
        publisher.publish(**message)

    result = send_paced(publish, seconds, rate)
    time.sleep(1.0)
    return result


def receive(kind: str, seconds: float, _rate: float) -> Result:
    """Receive messages until no more arrive."""
    ages: list[float] = []
    count, first, last, cpu = 0, 0.0, 0.0, 0.0

    def received(message: Any) -> None:
        nonlocal count, first, last, cpu
        ages.append(get_age(message))
        last = time.perf_counter()
        if not count:
            first, cpu = last, time.process_time()
        count += 1

    sdk, arguments = _load_sdk(kind, listens=True)
    subscriber = sdk.ROS2Subscriber(callback=received, **arguments)
    limit = time.monotonic() + seconds + 20
    while time.monotonic() < limit and not (count and time.perf_counter() - last > 1.0):
        time.sleep(0.1)
    assert subscriber is not None
    return Result(count, last - first, (time.process_time() - cpu) / max(last - first, 1e-9), compute_median_age(ages))
