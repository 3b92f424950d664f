"""What is shown of a recording at first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from linkwright.bag import BagReader, BagTopic
from linkwright.graph import DurabilityPolicy, ReliabilityPolicy
from linkwright.messages import TFMessage, deserialize
from linkwright.viewer.config.rviz_config import RvizConfig

_DESCRIPTION = "robot_description"
_TRANSFORMS = ("/tf", "/tf_static")
_FIRST_NS = 2_000_000_000
"""How much of a recording is looked at for its frames, nanoseconds."""

_USUAL_ROOTS = ("map", "odom", "world", "base_link", "base_footprint")
"""Frames to be looked from, the best first, where several are not in any other one (REP 105)."""

_DISPLAYS = (
    ("nav_msgs/msg/OccupancyGrid", "Map", 1),
    ("sensor_msgs/msg/LaserScan", "LaserScan", 4),
    ("sensor_msgs/msg/PointCloud2", "PointCloud2", 1),
    ("nav_msgs/msg/Path", "Path", 4),
    ("nav_msgs/msg/Odometry", "Odometry", 0),
    ("visualization_msgs/msg/MarkerArray", "MarkerArray", 4),
    ("visualization_msgs/msg/Marker", "Marker", 4),
    ("sensor_msgs/msg/Image", "Image", 1),
    ("sensor_msgs/msg/CompressedImage", "Image", 1),
)
"""Types, the display that shows them, and how many of these are switched on; others of them are there, but off."""


def recording_config(bag: BagReader) -> RvizConfig:
    """What is shown of a recording at first: its robot, and a display for each topic of the usual types.

    Transforms are drawn where there is no robot, which their axes would cover.

    Args:
        bag: the recording.
    """
    described = next((each.name for each in bag.topics if each.name.rpartition("/")[2] == _DESCRIPTION), None)
    config = RvizConfig.for_model(_fixed_frame(bag), frames=described is None, name=str(bag.path))
    for display in list(config.displays):
        kind = display.cls.rpartition("/")[2]
        if kind == "RobotModel" and described is None:
            config.remove(display)
        elif kind == "RobotModel" and described is not None:
            display.section.put(("Description Topic", "Value"), described, string=True)
        elif kind == "TF" and not {each.name for each in bag.topics}.intersection(_TRANSFORMS):
            config.remove(display)
    shown: Counter[str] = Counter()
    for message, kind, most in _DISPLAYS:
        for topic in (each for each in bag.topics if each.type_name == message and each.count):
            _add(config, kind, topic, checked=shown[kind] < most)
            shown[kind] += 1
    return config


def _add(config: RvizConfig, kind: str, topic: BagTopic, *, checked: bool) -> None:
    display = config.make(f"rviz_default_plugins/{kind}", topic.name.strip("/"))
    offers = topic.offered_qos
    display.section.put(("Topic", "Value"), topic.name, string=True)
    if any(each.reliability is ReliabilityPolicy.BEST_EFFORT for each in offers):
        display.section.put(("Topic", "Reliability Policy"), "Best Effort", string=True)
    kept = bool(offers) and all(each.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in offers)
    display.section.put(("Topic", "Durability Policy"), "Transient Local" if kept else "Volatile", string=True)
    config.insert(display)
    display.checked = checked


def _fixed_frame(bag: BagReader) -> str:
    """The frame that all others hang on, by the transforms at the beginning."""
    names = [each.name for each in bag.topics if each.name in _TRANSFORMS]
    batches = [deserialize(data, TFMessage).batch for _, _, data in bag.state_at(names, bag.start_ns + _FIRST_NS)]
    children = {name for batch in batches for name in batch.children}
    roots = dict.fromkeys(name for batch in batches for name in batch.parents if name not in children)
    return _best(roots)


def _best(roots: Iterable[str]) -> str:
    roots = list(roots)
    return next((name for name in _USUAL_ROOTS if name in roots), roots[0] if roots else _USUAL_ROOTS[0])
