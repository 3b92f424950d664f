"""Creates the initial configuration for a recording."""

from __future__ import annotations

from collections import Counter

from linkwright.bag import BagReader, BagTopic
from linkwright.bag.names import STATIC_TRANSFORMS, TRANSFORMS
from linkwright.graph import DurabilityPolicy, ReliabilityPolicy
from linkwright.messages import TFMessage, deserialize, get_message
from linkwright.rviz.config.rviz_config import RvizConfig
from linkwright.rviz.config.simulated_world import DESCRIPTION_TOPIC, POSES_TOPIC, RAYS_TOPIC, WORLD_DISPLAY
from linkwright.rviz.robot import size_of
from linkwright.sdf.poses import WORLD
from linkwright.urdf import Robot
from linkwright.viewer.recorded_robot import description_topic, namespace_of_transforms

_FIRST_NS = 2_000_000_000
"""The time of a recording that is read for its frames, nanoseconds."""

_USUAL_ROOTS = ("map", "odom", "world", "base_link", "base_footprint")
"""Frames for the camera to target, the best first, if there are several roots (REP 105)."""

_PLACES = ("map", "odom")
"""Frames in which a mobile robot moves (REP 105)."""

_LEAST_DISTANCE, _DISTANCE_FACTOR = 5.0, 1.5
"""The least distance of the camera from a mobile robot, metres, and a factor on its size to see all of it."""

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
"""Types, the display for each, and how many of these are enabled; further ones are added disabled."""


def recording_config(bag: BagReader, robot: Robot | None = None) -> RvizConfig:
    """Return a recording's initial configuration: its robot, and displays for topics of common types.

    TF is shown only if there is no robot, which the axes of TF would cover. A recording of a simulation shows the
    simulated world in the world frame; the robot model is disabled, because the world contains the robot.

    Args:
        bag: the recording.
        robot: the recorded robot, or None if it cannot be read.
    """
    described, namespace = description_topic(bag), namespace_of_transforms(bag)
    root, children = _tree(bag, namespace)
    world = _has_world(bag)
    fixed_frame = WORLD if world else root or (robot.root if robot is not None else _frame_of_messages(bag))
    config = RvizConfig.for_model(fixed_frame, frames=described is None, name=str(bag.path))
    base = next((name for name in _bases(robot) if name in children), None)
    if base is not None and root in _PLACES and not world:
        size = None if robot is None else size_of(robot)
        config.follow(base, _LEAST_DISTANCE if size is None else max(_LEAST_DISTANCE, _DISTANCE_FACTOR * size.distance))
    for display in list(config.displays):
        kind = display.cls.rpartition("/")[2]
        if kind == "RobotModel" and described is None:
            config.remove(display)
        elif kind == "RobotModel" and described is not None:
            display.section.put(("Description Topic", "Value"), described, string=True)
        elif kind == "TF" and root is None and robot is None:
            config.remove(display)
        if world and kind in ("RobotModel", "TF"):
            display.checked = False
    if world:
        shown_world = config.make(WORLD_DISPLAY, "World")
        config.insert(shown_world)
        shown_world.checked = True
    shown: Counter[str] = Counter()
    for message, kind, most in _DISPLAYS:
        for topic in (topic for topic in bag.topics if topic.type_name == message and topic.count):
            if world and topic.name.startswith(RAYS_TOPIC):
                continue  # the World display shows them
            own = not namespace or topic.name.startswith(f"{namespace}/")  # other robots have frames of the same names
            _add(config, kind, topic, checked=own and shown[kind] < most)
            shown[kind] += own
    return config


def _has_world(bag: BagReader) -> bool:
    """Return whether the recording contains a simulated world and the poses of its links."""
    there = {topic.name for topic in bag.topics if topic.count}
    return {DESCRIPTION_TOPIC, POSES_TOPIC} <= there


def _add(config: RvizConfig, kind: str, topic: BagTopic, *, checked: bool) -> None:
    display = config.make(f"rviz_default_plugins/{kind}", topic.name.strip("/"))
    offers = topic.offered_qos
    display.section.put(("Topic", "Value"), topic.name, string=True)
    if any(offer.reliability is ReliabilityPolicy.BEST_EFFORT for offer in offers):
        display.section.put(("Topic", "Reliability Policy"), "Best Effort", string=True)
    is_latched = bool(offers) and all(offer.durability is DurabilityPolicy.TRANSIENT_LOCAL for offer in offers)
    display.section.put(("Topic", "Durability Policy"), "Transient Local" if is_latched else "Volatile", string=True)
    config.insert(display)
    display.checked = checked


def _bases(robot: Robot | None) -> list[str]:
    """Return the candidates for the robot's base frame, best first (REP 105, REP 120)."""
    return ["base_footprint", "base_link"] if robot is None else [robot.root, *robot.links]


def _tree(bag: BagReader, namespace: str) -> tuple[str | None, set[str]]:
    """Return the root frame, or None, and the other frames, from the transforms at two moments.

    The moments are the beginning of the transforms and the middle of the recording, because a node that localizes the
    robot on a map may have started later.
    """
    both = namespace + TRANSFORMS, namespace + STATIC_TRANSFORMS
    names = [topic.name for topic in bag.topics if topic.name in both and topic.count]
    moving = [name for name in names if name == both[0]]
    first = next(iter(bag.messages(moving or names)), None) if names else None
    if first is None:
        return None, set()
    moments = first[1] + _FIRST_NS, (bag.start_ns + bag.end_ns) // 2
    batches = [deserialize(data, TFMessage).batch for moment in moments for _, _, data in bag.state_at(names, moment)]
    children = {name for batch in batches for name in batch.children}
    roots = dict.fromkeys(name for batch in batches for name in batch.parents if name not in children)
    return next((name for name in _USUAL_ROOTS if name in roots), next(iter(roots), None)), children


def _frame_of_messages(bag: BagReader) -> str:
    """Return the frame of the first displayed message: the Fixed Frame if there are no transforms."""
    for message, _, _ in _DISPLAYS:
        for topic in (topic for topic in bag.topics if topic.type_name == message and topic.count):
            first = next(iter(bag.messages([topic.name])), None)
            if first is not None and (frame := _frame_of(first[2], message)):
                return frame
    return _USUAL_ROOTS[0]


def _frame_of(data: bytes, type_name: str) -> str:
    message = deserialize(data, get_message(type_name))
    headers = [message.header] if hasattr(message, "header") else [marker.header for marker in message.markers]
    return next((str(header.frame_id) for header in headers if header.frame_id), "")
