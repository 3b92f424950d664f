"""Measure writing and reading of messages, compared with rosbags and Cyclone DDS's Python structures.

Run it with ``python -m benchmarks messages``. "Written" is a message object to the bytes that go onto the wire, "read"
is bytes to an object of which every field can be read at once; of TFMessage also to and from the arrays that the
program's own nodes use. Cyclone's figures are left out for images and clouds, which take it tens of milliseconds.
"""

from __future__ import annotations

import sys
import timeit
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from rosbags.typesys import Stores, get_typestore

from benchmarks.measure import Row, commands, side_by_side
from linkwright.messages import (
    Header,
    JointState,
    TFMessage,
    Time,
    Transform,
    TransformBatch,
    TransformStamped,
    deserialize,
    get_message,
    serialize,
    to_dict,
    to_yaml,
)
from linkwright.messages.definitions.interfaces import Container, FieldType

ROUNDS = 9
MICROSECONDS = 1e6


def joint_state() -> Any:
    """Return the states of twelve joints."""
    values = np.linspace(-1.0, 1.0, 12)
    names = [f"arm_{number}_joint" for number in range(12)]
    return JointState(
        header=Header(stamp=Time(sec=1_700_000_000, nanosec=5), frame_id="base_link"),
        name=names,
        position=values,
        velocity=values,
        effort=values,
    )


def transforms(count: int) -> Any:
    """Return the transforms of a number of links."""
    header = Header(stamp=Time(sec=1_700_000_000, nanosec=5), frame_id="base_link")
    return TFMessage(
        transforms=[
            TransformStamped(header=header, child_frame_id=f"link_{number}", transform=Transform())
            for number in range(count)
        ]
    )


def messages() -> dict[str, Any]:
    """Return the measured messages, by their names in the table."""
    header = Header(stamp=Time(sec=1_700_000_000, nanosec=5), frame_id="camera")
    pixels = np.arange(640 * 480 * 3, dtype=np.uint8)
    laser = np.linspace(0.0, 10.0, 720, dtype=np.float32)
    image = get_message("sensor_msgs/msg/Image")
    scan = get_message("sensor_msgs/msg/LaserScan")
    cloud = get_message("sensor_msgs/msg/PointCloud2")
    field = get_message("sensor_msgs/msg/PointField")
    fields = [field(name=name, offset=4 * number, datatype=7, count=1) for number, name in enumerate("xyz")]
    return {
        "String": get_message("std_msgs/msg/String")(data="hello world"),
        "Twist": get_message("geometry_msgs/msg/Twist")(),
        "JointState, 12 joints": joint_state(),
        "TFMessage, 12 transforms": transforms(12),
        "TFMessage, 100 transforms": transforms(100),
        "Odometry": get_message("nav_msgs/msg/Odometry")(header=header, child_frame_id="base_link"),
        "LaserScan, 720 ranges": scan(header=header, ranges=laser, intensities=laser),
        "Image, 640x480x3": image(header=header, height=480, width=640, encoding="rgb8", step=1920, data=pixels),
        "PointCloud2, 20 000 points": cloud(
            header=header, width=20_000, point_step=12, fields=fields, data=pixels[:240_000]
        ),
    }


def rosbags_object(store: Any, message: Any) -> Any:
    """Return the same message as an object of rosbags."""

    def value(kind: FieldType, given: Any) -> Any:
        if kind.primitive is None:
            one = kind.container is Container.ONE
            return rosbags_object(store, given) if one else [rosbags_object(store, item) for item in given]
        return np.array(given, kind.primitive.dtype) if kind.is_numeric_array else given

    values = {field.name: value(field.type, getattr(message, field.name)) for field in message._definition.fields}
    return store.types[message.TYPE_NAME](**values)


def cyclone_types() -> tuple[type[Any], type[Any]]:
    """Return JointState and TFMessage as users of cyclonedds define them."""
    from dataclasses import make_dataclass

    from cyclonedds.idl import IdlStruct, types

    def struct(title: str, /, **fields: Any) -> type[Any]:
        return make_dataclass(title, list(fields.items()), bases=(IdlStruct,))

    stamp = struct("Time", sec=types.int32, nanosec=types.uint32)
    header = struct("Header", stamp=stamp, frame_id=str)
    doubles = types.sequence[types.float64]
    state = struct(
        "JointState", header=header, name=types.sequence[str], position=doubles, velocity=doubles, effort=doubles
    )
    vector = struct("Vector3", x=types.float64, y=types.float64, z=types.float64)
    turn = struct("Quaternion", x=types.float64, y=types.float64, z=types.float64, w=types.float64)
    transform = struct("Transform", translation=vector, rotation=turn)
    stamped = struct("TransformStamped", header=header, child_frame_id=str, transform=transform)
    return state, struct("TFMessage", transforms=types.sequence[stamped])


def cyclone_object(cls: type[Any], message: Any) -> Any:
    """Return the same message as a structure of cyclonedds."""
    from dataclasses import fields

    values = {}
    for field in fields(cls):
        value = getattr(message, field.name)
        if hasattr(value, "TYPE_NAME"):
            value = cyclone_object(field.type, value)
        elif isinstance(value, list) and value and hasattr(value[0], "TYPE_NAME"):
            (inner,) = (field.type.__metadata__[0].subtype,)
            value = [cyclone_object(inner, item) for item in value]
        elif not isinstance(value, (str, int, float)):
            value = list(value)
        values[field.name] = value
    return cls(**values)


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    found: list[Row] = []
    state, tf = cyclone_types()
    plain = {JointState: state, TFMessage: tf}
    for what, message in messages().items():
        name, data, theirs = message.TYPE_NAME, serialize(message), rosbags_object(store, message)
        assert bytes(store.serialize_cdr(theirs, name)) == data
        cls = type(message)
        struct = plain.get(cls)
        other = cyclone_object(struct, message) if struct else None
        found.append(
            _row(
                f"{what}: written",
                lambda m=message: serialize(m),
                rosbags=lambda o=theirs, n=name: store.serialize_cdr(o, n),
                cyclonedds=other.serialize if other else None,
            )
        )
        found.append(
            _row(
                f"{what}: read",
                lambda d=data, c=cls: _all_of(deserialize(d, c)),
                rosbags=lambda d=data, n=name: store.deserialize_cdr(d, n),
                cyclonedds=partial(struct.deserialize, other.serialize()) if struct and other else None,
            )
        )
    batch = TFMessage(batch=transforms(100).batch)
    data = serialize(batch)
    found.append(_row("TFMessage, 100 transforms: written from arrays", lambda: serialize(batch)))
    found.append(_row("TFMessage, 100 transforms: read as arrays", lambda: _batch(data)))
    found += _texts()
    found.append(_start())
    return found


def _all_of(message: Any) -> Any:
    """Create the objects of a TFMessage, which otherwise are created on demand."""
    return message.transforms if type(message) is TFMessage else message


def _batch(data: bytes) -> TransformBatch:
    return deserialize(data, TFMessage).batch


def _texts() -> list[Row]:
    import yaml

    message = transforms(100)

    def pyyaml() -> str:
        text: str = yaml.safe_dump(_plain(to_dict(message)), sort_keys=False)
        return text

    return [_row("TFMessage, 100 transforms: to YAML", lambda: to_yaml(message), rounds=5, PyYAML=pyyaml)]


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    return [_plain(item) for item in value] if isinstance(value, list) else value


def _start() -> Row:
    """Measure the additional start-up time of the messages in a program that imports numpy."""
    known = "from linkwright.messages import JointState, TFMessage, String"
    times = commands(
        {
            "with": [sys.executable, "-c", f"import numpy, linkwright.packages; {known}"],
            "without": [sys.executable, "-c", "import numpy, linkwright.packages"],
        },
        rounds=15,
    )
    return Row("import of the messages, numpy being there", (times["with"] - times["without"]) * 1e3, "ms", "10 ms")


def _row(what: str, ours: Callable[[], object], rounds: int = ROUNDS, **peers: Callable[[], object] | None) -> Row:
    repeat = _repeat(ours)
    times = side_by_side({"ours": ours}, rounds, repeat)
    for name, call in peers.items():
        if call is not None:
            times |= side_by_side({name: call}, rounds, _repeat(call))
    others = {name: times[name] * MICROSECONDS for name, call in peers.items() if call is not None}
    return Row(what, times["ours"] * MICROSECONDS, "µs", "", others)


def _repeat(call: Callable[[], object]) -> int:
    """Return the number of calls with which a turn takes some milliseconds."""
    seconds = min(timeit.repeat(call, number=1, repeat=7))
    return max(1, min(2000, int(0.01 / max(seconds, 1e-7))))
