"""Measure writing and reading of messages, compared with rosbags and cyclonedds.

Run it with ``python -m benchmarks messages``. "Written" converts a message object to the bytes for the wire, "read"
converts bytes to an object with all fields; for TFMessage, also to and from the arrays that the program's own nodes
use. Cyclone's figures are left out for images and clouds, for which it needs tens of milliseconds.
"""

from __future__ import annotations

import sys
import timeit
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from rosbags.typesys import Stores, get_typestore

from benchmarks.measure import Row, measure_commands, measure_side_by_side
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
MICROSECONDS_PER_SECOND = 1e6


def make_joint_state() -> Any:
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


def make_transforms(count: int) -> Any:
    """Return the transforms of a number of links."""
    header = Header(stamp=Time(sec=1_700_000_000, nanosec=5), frame_id="base_link")
    return TFMessage(
        transforms=[
            TransformStamped(header=header, child_frame_id=f"link_{number}", transform=Transform())
            for number in range(count)
        ]
    )


def make_messages() -> dict[str, Any]:
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
        "JointState, 12 joints": make_joint_state(),
        "TFMessage, 12 transforms": make_transforms(12),
        "TFMessage, 100 transforms": make_transforms(100),
        "Odometry": get_message("nav_msgs/msg/Odometry")(header=header, child_frame_id="base_link"),
        "LaserScan, 720 ranges": scan(header=header, ranges=laser, intensities=laser),
        "Image, 640x480x3": image(header=header, height=480, width=640, encoding="rgb8", step=1920, data=pixels),
        "PointCloud2, 20 000 points": cloud(
            header=header, width=20_000, point_step=12, fields=fields, data=pixels[:240_000]
        ),
    }


def make_rosbags_object(store: Any, message: Any) -> Any:
    """Return the same message as an object of rosbags."""

    def value(kind: FieldType, field_value: Any) -> Any:
        if kind.primitive is None:
            is_single = kind.container is Container.ONE
            return (
                make_rosbags_object(store, field_value)
                if is_single
                else [make_rosbags_object(store, item) for item in field_value]
            )
        return np.array(field_value, kind.primitive.dtype) if kind.is_numeric_array else field_value

    values = {field.name: value(field.type, getattr(message, field.name)) for field in message._definition.fields}
    return store.types[message.TYPE_NAME](**values)


def make_cyclone_types() -> tuple[type[Any], type[Any]]:
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


def make_cyclone_object(cls: type[Any], message: Any) -> Any:
    """Return the same message as a structure of cyclonedds."""
    from dataclasses import fields

    values = {}
    for field in fields(cls):
        value = getattr(message, field.name)
        if hasattr(value, "TYPE_NAME"):
            value = make_cyclone_object(field.type, value)
        elif isinstance(value, list) and value and hasattr(value[0], "TYPE_NAME"):
            (inner,) = (field.type.__metadata__[0].subtype,)
            value = [make_cyclone_object(inner, item) for item in value]
        elif not isinstance(value, (str, int, float)):
            value = list(value)
        values[field.name] = value
    return cls(**values)


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    table: list[Row] = []
    state, tf = make_cyclone_types()
    plain = {JointState: state, TFMessage: tf}
    for what, message in make_messages().items():
        name, data, rosbags_message = message.TYPE_NAME, serialize(message), make_rosbags_object(store, message)
        assert bytes(store.serialize_cdr(rosbags_message, name)) == data
        cls = type(message)
        struct = plain.get(cls)
        other = make_cyclone_object(struct, message) if struct else None
        table.append(
            _measure_row(
                f"{what}: written",
                lambda m=message: serialize(m),
                rosbags=lambda o=rosbags_message, n=name: store.serialize_cdr(o, n),
                cyclonedds=other.serialize if other else None,
            )
        )
        table.append(
            _measure_row(
                f"{what}: read",
                lambda d=data, c=cls: _create_objects(deserialize(d, c)),
                rosbags=lambda d=data, n=name: store.deserialize_cdr(d, n),
                cyclonedds=partial(struct.deserialize, other.serialize()) if struct and other else None,
            )
        )
    batch = TFMessage(batch=make_transforms(100).batch)
    data = serialize(batch)
    table.append(_measure_row("TFMessage, 100 transforms: written from arrays", lambda: serialize(batch)))
    table.append(_measure_row("TFMessage, 100 transforms: read as arrays", lambda: _read_batch(data)))
    table += _measure_texts()
    table.append(_measure_start())
    return table


def _create_objects(message: Any) -> Any:
    """Create the objects of a TFMessage, which otherwise are created on demand."""
    return message.transforms if type(message) is TFMessage else message


def _read_batch(data: bytes) -> TransformBatch:
    return deserialize(data, TFMessage).batch


def _measure_texts() -> list[Row]:
    import yaml

    message = make_transforms(100)

    def pyyaml() -> str:
        text: str = yaml.safe_dump(_to_plain_value(to_dict(message)), sort_keys=False)
        return text

    return [_measure_row("TFMessage, 100 transforms: to YAML", lambda: to_yaml(message), rounds=5, PyYAML=pyyaml)]


def _to_plain_value(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _to_plain_value(item) for key, item in value.items()}
    return [_to_plain_value(item) for item in value] if isinstance(value, list) else value


def _measure_start() -> Row:
    """Measure the additional start-up time of the messages in a program that imports numpy."""
    known = "from linkwright.messages import JointState, TFMessage, String"
    times = measure_commands(
        {
            "with": [sys.executable, "-c", f"import numpy, linkwright.packages; {known}"],
            "without": [sys.executable, "-c", "import numpy, linkwright.packages"],
        },
        rounds=15,
    )
    return Row("import of the messages, numpy being there", (times["with"] - times["without"]) * 1e3, "ms", "10 ms")


def _measure_row(
    what: str, ours: Callable[[], object], rounds: int = ROUNDS, **peers: Callable[[], object] | None
) -> Row:
    repeat = _choose_repeat_count(ours)
    times = measure_side_by_side({"ours": ours}, rounds, repeat)
    for name, call in peers.items():
        if call is not None:
            times |= measure_side_by_side({name: call}, rounds, _choose_repeat_count(call))
    peer_times = {name: times[name] * MICROSECONDS_PER_SECOND for name, call in peers.items() if call is not None}
    return Row(what, times["ours"] * MICROSECONDS_PER_SECOND, "µs", "", peer_times)


def _choose_repeat_count(call: Callable[[], object]) -> int:
    """Return the number of calls with which a turn takes some milliseconds."""
    seconds = min(timeit.repeat(call, number=1, repeat=7))
    return max(1, min(2000, int(0.01 / max(seconds, 1e-7))))
