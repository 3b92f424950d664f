"""Creates the initial configuration for a recording."""

from __future__ import annotations

from collections import Counter

from linkwright.bag import BagReader, BagTopic
from linkwright.bag.names import STATIC_TRANSFORMS, TRANSFORMS
from linkwright.graph import DurabilityPolicy, ReliabilityPolicy
from linkwright.messages import TFMessage, deserialize, get_message
from linkwright.rviz.config.rviz_config import RvizConfig
from linkwright.rviz.config.simulated_world import DESCRIPTION_TOPIC, POSES_TOPIC, RAYS_TOPIC, WORLD_DISPLAY
from linkwright.rviz.robot import estimate_size
from linkwright.sdf.poses import WORLD
from linkwright.urdf import Robot
from linkwright.viewer.recorded_robot import find_description_topic, find_transform_namespace

_SETTLING_TIME_NS = 2_000_000_000
"""The time between the first transform and the reading of the frames, in nanoseconds."""

_PREFERRED_ROOTS = ("map", "odom", "world", "base_link", "base_footprint")
"""The preferred Fixed Frames if there are several root frames, the best first (REP 105)."""

_WORLD_FIXED_FRAMES = ("map", "odom")
"""The root frames in which a mobile robot moves (REP 105)."""

_MIN_DISTANCE, _DISTANCE_FACTOR = 5.0, 1.5
"""The minimum distance in m of the camera from a mobile robot, and a factor on the distance for its size."""

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
"""Message types, the display for each, and the number of enabled displays. Further displays are disabled."""


def create_recording_config(bag: BagReader, robot: Robot | None = None) -> RvizConfig:
    """Return the initial configuration of a recording: robot and displays of common topics.

    TF is enabled only if there is no robot, because its axes would cover the robot. A recording of a simulation shows
    the simulated world in the world frame. The robot model is then disabled, because the world contains the robot.

    Args:
        bag: the recording.
        robot: the recorded robot, or None if it cannot be read.
    """
    description_topic_name, namespace = find_description_topic(bag), find_transform_namespace(bag)
    root, children = _find_root_and_frames(bag, namespace)
    has_world = _has_world(bag)
    fixed_frame = WORLD if has_world else root or (robot.root if robot is not None else _find_message_frame(bag))
    config = RvizConfig.for_model(fixed_frame, frames=description_topic_name is None, name=str(bag.path))
    base_frame = next((name for name in _list_base_frames(robot) if name in children), None)
    if base_frame is not None and root in _WORLD_FIXED_FRAMES and not has_world:
        size = None if robot is None else estimate_size(robot)
        config.follow_frame(
            base_frame, _MIN_DISTANCE if size is None else max(_MIN_DISTANCE, _DISTANCE_FACTOR * size.distance)
        )
    for display in list(config.displays):
        display_kind = display.cls.rpartition("/")[2]
        if display_kind == "RobotModel" and description_topic_name is None:
            config.remove(display)
        elif display_kind == "RobotModel" and description_topic_name is not None:
            display.section.put(("Description Topic", "Value"), description_topic_name, string=True)
        elif display_kind == "TF" and root is None and robot is None:
            config.remove(display)
        if has_world and display_kind in ("RobotModel", "TF"):
            display.checked = False
    if has_world:
        world_display = config.make_display(WORLD_DISPLAY, "World")
        config.insert(world_display)
        world_display.checked = True
    enabled_counts: Counter[str] = Counter()
    for message, display_kind, max_enabled in _DISPLAYS:
        for topic in (topic for topic in bag.topics if topic.type_name == message and topic.count):
            if has_world and topic.name.startswith(RAYS_TOPIC):
                continue  # the World display shows these rays
            is_own_topic = not namespace or topic.name.startswith(
                f"{namespace}/"
            )  # other robots have frames of the same names
            _add_display(
                config, display_kind, topic, checked=is_own_topic and enabled_counts[display_kind] < max_enabled
            )
            enabled_counts[display_kind] += is_own_topic
    return config


def _has_world(bag: BagReader) -> bool:
    """Return whether the recording contains a simulated world and the poses of its links."""
    recorded_topics = {topic.name for topic in bag.topics if topic.count}
    return {DESCRIPTION_TOPIC, POSES_TOPIC} <= recorded_topics


def _add_display(config: RvizConfig, display_class: str, topic: BagTopic, *, checked: bool) -> None:
    display = config.make_display(f"rviz_default_plugins/{display_class}", topic.name.strip("/"))
    offered_profiles = topic.offered_qos
    display.section.put(("Topic", "Value"), topic.name, string=True)
    if any(offer.reliability is ReliabilityPolicy.BEST_EFFORT for offer in offered_profiles):
        display.section.put(("Topic", "Reliability Policy"), "Best Effort", string=True)
    is_latched = bool(offered_profiles) and all(
        offer.durability is DurabilityPolicy.TRANSIENT_LOCAL for offer in offered_profiles
    )
    display.section.put(("Topic", "Durability Policy"), "Transient Local" if is_latched else "Volatile", string=True)
    config.insert(display)
    display.checked = checked


def _list_base_frames(robot: Robot | None) -> list[str]:
    """Return the candidates for the base frame of the robot, the best first (REP 105, REP 120)."""
    return ["base_footprint", "base_link"] if robot is None else [robot.root, *robot.links]


def _find_root_and_frames(bag: BagReader, namespace: str) -> tuple[str | None, set[str]]:
    """Return the root frame, or None, and the other frames, from the transforms at two times.

    The times are shortly after the first transform and the middle of the recording, because a node that localizes the
    robot on a map may have started later.
    """
    transform_topics = namespace + TRANSFORMS, namespace + STATIC_TRANSFORMS
    names = [topic.name for topic in bag.topics if topic.name in transform_topics and topic.count]
    moving_topics = [name for name in names if name == transform_topics[0]]
    first_message = next(iter(bag.messages(moving_topics or names)), None) if names else None
    if first_message is None:
        return None, set()
    times_ns = first_message[1] + _SETTLING_TIME_NS, (bag.start_ns + bag.end_ns) // 2
    batches = [deserialize(data, TFMessage).batch for moment in times_ns for _, _, data in bag.state_at(names, moment)]
    children = {name for batch in batches for name in batch.children}
    roots = dict.fromkeys(name for batch in batches for name in batch.parents if name not in children)
    return next((name for name in _PREFERRED_ROOTS if name in roots), next(iter(roots), None)), children


def _find_message_frame(bag: BagReader) -> str:
    """Return the frame of the first displayed message.

    It is the Fixed Frame if there are no transforms.
    """
    for message, _, _ in _DISPLAYS:
        for topic in (topic for topic in bag.topics if topic.type_name == message and topic.count):
            first_message = next(iter(bag.messages([topic.name])), None)
            if first_message is not None and (frame := _read_frame(first_message[2], message)):
                return frame
    return _PREFERRED_ROOTS[0]


def _read_frame(data: bytes, type_name: str) -> str:
    message = deserialize(data, get_message(type_name))
    headers = [message.header] if hasattr(message, "header") else [marker.header for marker in message.markers]
    return next((str(header.frame_id) for header in headers if header.frame_id), "")
