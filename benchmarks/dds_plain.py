"""The peer of `dds_sides`: `cyclonedds` alone, with IdlStructs that serialize themselves.

Its annotations are not postponed: `cyclonedds` reads them as types.
"""

import itertools
import os
import time
from dataclasses import dataclass
from typing import Any

from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct, types
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from benchmarks.dds_sides import HEIGHT, JOINT_COUNT, TRANSFORM_COUNT, WIDTH, Result, renew, send_paced
from linkwright.wire.dds.settings import read_settings

QOS = Qos(Policy.Reliability.Reliable(duration(milliseconds=100)), Policy.History.KeepAll)


@dataclass
class Time(IdlStruct):
    """``builtin_interfaces/msg/Time``."""

    sec: types.int32
    nanosec: types.uint32


@dataclass
class Header(IdlStruct):
    """``std_msgs/msg/Header``."""

    stamp: Time
    frame_id: str


@dataclass
class JointState(IdlStruct):
    """``sensor_msgs/msg/JointState``."""

    header: Header
    name: types.sequence[str]
    position: types.sequence[types.float64]
    velocity: types.sequence[types.float64]
    effort: types.sequence[types.float64]


@dataclass
class Vector3(IdlStruct):
    """``geometry_msgs/msg/Vector3``."""

    x: types.float64
    y: types.float64
    z: types.float64


@dataclass
class Quaternion(IdlStruct):
    """``geometry_msgs/msg/Quaternion``."""

    x: types.float64
    y: types.float64
    z: types.float64
    w: types.float64


@dataclass
class Transform(IdlStruct):
    """``geometry_msgs/msg/Transform``."""

    translation: Vector3
    rotation: Quaternion


@dataclass
class TransformStamped(IdlStruct):
    """``geometry_msgs/msg/TransformStamped``."""

    header: Header
    child_frame_id: str
    transform: Transform


@dataclass
class TFMessage(IdlStruct):
    """``tf2_msgs/msg/TFMessage``."""

    transforms: types.sequence[TransformStamped]


@dataclass
class Image(IdlStruct):
    """``sensor_msgs/msg/Image``."""

    header: Header
    height: types.uint32
    width: types.uint32
    encoding: str
    is_bigendian: types.uint8
    step: types.uint32
    data: types.sequence[types.uint8]


def make_message(kind: str) -> Any:
    """Return a message with the same content as `dds_sides.ours`."""
    header = Header(Time(0, 0), "base_link")
    if kind == "joints":
        names = [f"joint_{number}" for number in range(JOINT_COUNT)]
        return JointState(header, names, [0.1] * JOINT_COUNT, [0.2] * JOINT_COUNT, [0.3] * JOINT_COUNT)
    if kind in ("transforms", "objects"):
        transform = Transform(Vector3(0.0, 0.0, 0.0), Quaternion(0.0, 0.0, 0.0, 1.0))
        return TFMessage(
            transforms=[TransformStamped(header, f"link_{number}", transform) for number in range(TRANSFORM_COUNT)]
        )
    return Image(header, HEIGHT, WIDTH, "rgb8", 0, 3 * WIDTH, bytes(3 * WIDTH * HEIGHT))


class _Side:
    """A participant in the same domain and with the same settings as Linkwright's."""

    def __init__(self, kind: str) -> None:
        number = int(os.environ["ROS_DOMAIN_ID"])
        self.domain = Domain(number, read_settings().configurations[0])
        self.participant = DomainParticipant(number)
        self.topic = Topic(self.participant, f"plain_{kind}", type(make_message(kind)))


def send(kind: str, seconds: float, rate: float) -> Result:
    """Write samples at a rate for some seconds."""
    side = _Side(kind)
    writer = DataWriter(side.participant, side.topic, QOS)
    while not writer.get_matched_subscriptions():
        time.sleep(0.01)
    sample = make_message(kind)
    numbers = itertools.count()

    def write() -> None:
        renew(sample, next(numbers))
        writer.write(sample)

    result = send_paced(write, seconds, rate)
    time.sleep(1.0)
    return result


def receive(kind: str, seconds: float, _rate: float) -> Result:
    """Take samples until no more arrive."""
    side = _Side(kind)
    reader = DataReader(side.participant, side.topic, QOS)
    count, first, last, cpu = 0, 0.0, 0.0, 0.0
    limit = time.monotonic() + seconds + 20
    while time.monotonic() < limit and not (count and time.perf_counter() - last > 1.0):
        sample_count = sum(1 for sample in reader.take(256) if isinstance(sample, IdlStruct))
        if sample_count:
            last = time.perf_counter()
            if not count:
                first, cpu = last, time.process_time()
            count += sample_count
        else:
            time.sleep(0.001)
    return Result(count, last - first, (time.process_time() - cpu) / max(last - first, 1e-9))
