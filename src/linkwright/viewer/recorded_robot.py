"""Computes the transforms of a robot from joint states, for recordings without transforms."""

from __future__ import annotations

from linkwright.bag import BagReader, PublishedRecording
from linkwright.bag.names import STATIC_TRANSFORMS, TRANSFORMS
from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import STATIC_TF_PUBLISHER_QOS, TF_QOS, Node
from linkwright.messages import JointState, String, TFMessage, deserialize
from linkwright.nodes.joint_layout import JointSettings, make_layout
from linkwright.nodes.robot_state_publisher import RobotTransforms
from linkwright.urdf import Robot

_JOINT_STATES = "sensor_msgs/msg/JointState"


_DESCRIPTION_SUFFIX = "/robot_description"


def find_description_topic(bag: BagReader) -> str | None:
    """Return the topic with the description of the recorded robot, or None if there is none."""
    names = [topic.name for topic in bag.topics if topic.count and topic.name.endswith(_DESCRIPTION_SUFFIX)]
    preferred_topic = find_transform_namespace(bag) + _DESCRIPTION_SUFFIX
    return preferred_topic if preferred_topic in names else next(iter(names), None)


def find_transform_namespace(bag: BagReader) -> str:
    """Return the namespace of the transforms of a robot, such as ``/robot1``.

    The namespace is empty if there are transforms without a namespace. If there are several robots, the first robot
    with a description is selected.
    """
    names = [topic.name for topic in bag.topics if topic.count]
    if TRANSFORMS in names or STATIC_TRANSFORMS in names:
        return ""
    namespaces = [name.removesuffix(TRANSFORMS) for name in names if name.endswith(TRANSFORMS)]
    namespaces_with_description = [namespace for namespace in namespaces if namespace + _DESCRIPTION_SUFFIX in names]
    return next(iter(namespaces_with_description or namespaces), "")


def lacks_transforms(bag: BagReader) -> bool:
    """Return whether a recording has no messages on the topic of moving transforms."""
    transforms_topic = find_transform_namespace(bag) + TRANSFORMS
    return not any(topic.name == transforms_topic and topic.count for topic in bag.topics)


def read_robot(bag: BagReader, library: DescriptionLibrary) -> Robot | None:
    """Return the robot of a recording, or None if it has no description that can be read.

    Args:
        bag: the recording.
        library: reads the description of the robot.
    """
    topic = find_description_topic(bag)
    if topic is None:
        return None
    try:
        first_message = next(iter(bag.messages([topic])), None)
        return None if first_message is None else library.read(deserialize(first_message[2], String).data).robot
    except LinkwrightError:
        return None  # the RobotModel display reports the error


class RecordingWithTransforms:
    """A publisher of a recording, and of transforms computed from its joint states.

    The transforms are the same as robot_state_publisher's. Joints without a joint state are at zero, or in the
    middle of their limits if the limits exclude zero.

    Args:
        recording: publishes the recorded messages.
        node: publishes the transforms.
        bag: the recording.
        robot: the robot, which has no transforms in the recording.
    """

    def __init__(self, recording: PublishedRecording, node: Node, bag: BagReader, robot: Robot) -> None:
        self._recording = recording
        self._description = find_description_topic(bag)
        self._joint_states_topic = next((topic.name for topic in bag.topics if topic.type_name == _JOINT_STATES), None)
        self._transforms = RobotTransforms(robot, "")
        self._zero_positions = _compute_zero_positions(robot)
        self._positions = dict(self._zero_positions)
        self._last_time_ns = 0
        self._tf_publisher = node.create_publisher(TFMessage, TRANSFORMS, TF_QOS)
        self._fixed = node.create_publisher(TFMessage, STATIC_TRANSFORMS, STATIC_TF_PUBLISHER_QOS)
        node.get_logger().info("The recording has no /tf: the robot's transforms are computed from its joint states")

    def subscribed_topics(self) -> frozenset[str]:
        """Return the topics of the recording that have subscriptions.

        If the transforms have subscriptions, the topics that they are computed from are included.
        """
        topics = self._recording.subscribed_topics()
        if self._tf_publisher.get_subscription_count():
            topics |= {topic for topic in (self._description, self._joint_states_topic) if topic is not None}
        return topics

    def publish_time(self, stamp_ns: int) -> None:
        """Publish a time on ``/clock``."""
        self._recording.publish_time(stamp_ns)

    def publish(self, topic: str, stamp_ns: int, data: bytes) -> None:
        """Publish a message, and the transforms that the message changes."""
        self._recording.publish(topic, stamp_ns, data)
        if stamp_ns < self._last_time_ns:
            self._positions = dict(self._zero_positions)
        self._last_time_ns = stamp_ns
        if topic == self._description:
            self._fixed.publish(TFMessage(batch=self._transforms.fixed_transforms(stamp_ns)))
            if self._joint_states_topic is None:
                self._publish_transforms(stamp_ns)
        elif topic == self._joint_states_topic:
            joint_states = deserialize(data, JointState)
            self._positions.update(zip(joint_states.name, joint_states.position, strict=False))
            self._publish_transforms(joint_states.header.stamp.nanoseconds or stamp_ns)

    def _publish_transforms(self, stamp_ns: int) -> None:
        batch = self._transforms.find_conversion(tuple(self._positions)).batch(list(self._positions.values()), stamp_ns)
        if len(batch):
            self._tf_publisher.publish(TFMessage(batch=batch))


def publish_recording(bag: BagReader, node: Node, robot: Robot | None) -> PublishedRecording | RecordingWithTransforms:
    """Return the object that publishes a recording in a separate graph.

    Args:
        bag: the recording.
        node: the node that publishes.
        robot: the robot that `read_robot` returned, or None.
    """
    namespace = find_transform_namespace(bag)
    recording = PublishedRecording(node, bag, namespace)
    if namespace:
        node.get_logger().info(f"The recording has no /tf: {namespace}{TRANSFORMS} replaces it")
    return (
        RecordingWithTransforms(recording, node, bag, robot)
        if robot is not None and lacks_transforms(bag)
        else recording
    )


def _compute_zero_positions(robot: Robot) -> dict[str, float]:
    try:
        return {joint.name: joint.zero for joint in make_layout(robot, JointSettings()).free}
    except LinkwrightError:  # joints that mimic each other in a cycle have no positions
        return {}
