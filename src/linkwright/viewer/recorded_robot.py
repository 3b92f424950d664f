"""The robot of a recording without transforms, whose link poses are computed from joint states."""

from __future__ import annotations

from linkwright.bag import BagReader, PublishedRecording
from linkwright.bag.names import STATIC_TRANSFORMS, TRANSFORMS
from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import STATIC_TF_PUBLISHER_QOS, TF_QOS, Node
from linkwright.messages import JointState, String, TFMessage, deserialize
from linkwright.nodes.joint_layout import JointSettings, layout_of
from linkwright.nodes.robot_state_publisher import RobotTransforms
from linkwright.urdf import Robot

_JOINT_STATES = "sensor_msgs/msg/JointState"


_DESCRIPTION = "/robot_description"


def description_topic(bag: BagReader) -> str | None:
    """Return the topic with the description of the recording's robot; None if there is none."""
    names = [topic.name for topic in bag.topics if topic.count and topic.name.endswith(_DESCRIPTION)]
    own = namespace_of_transforms(bag) + _DESCRIPTION
    return own if own in names else next(iter(names), None)


def namespace_of_transforms(bag: BagReader) -> str:
    """Return the namespace of a robot's transforms, such as ``/robot1``.

    The namespace is empty unless all transforms have one. If there are several robots, the first one with a description
    is selected.
    """
    names = [topic.name for topic in bag.topics if topic.count]
    if TRANSFORMS in names or STATIC_TRANSFORMS in names:
        return ""
    found = [name.removesuffix(TRANSFORMS) for name in names if name.endswith(TRANSFORMS)]
    described = [namespace for namespace in found if namespace + _DESCRIPTION in names]
    return next(iter(described or found), "")


def lacks_transforms(bag: BagReader) -> bool:
    """Return whether a recording has no moving transforms, but only joint states."""
    moving = namespace_of_transforms(bag) + TRANSFORMS
    return not any(topic.name == moving and topic.count for topic in bag.topics)


def robot_of(bag: BagReader, library: DescriptionLibrary) -> Robot | None:
    """Return the robot of a recording, or None if it has no description that can be read.

    Args:
        bag: the recording.
        library: reads the robot's description.
    """
    topic = description_topic(bag)
    if topic is None:
        return None
    try:
        first = next(iter(bag.messages([topic])), None)
        return None if first is None else library.read(deserialize(first[2], String).data).robot
    except LinkwrightError:
        return None  # the RobotModel display reports the error


class PlacedRobot:
    """Publishes a recording, and transforms computed from its joint states.

    The transforms are those that robot_state_publisher would publish. Joints without a message so far are at zero, or
    in the middle of their limits if the limits exclude zero.

    Args:
        recording: publishes the recorded messages.
        node: publishes the transforms.
        bag: the recording.
        robot: the robot, which has no transforms in the recording.
    """

    def __init__(self, recording: PublishedRecording, node: Node, bag: BagReader, robot: Robot) -> None:
        self._recording = recording
        self._description = description_topic(bag)
        self._joint_states = next((topic.name for topic in bag.topics if topic.type_name == _JOINT_STATES), None)
        self._transforms = RobotTransforms(robot, "")
        self._zeros = _zeros(robot)
        self._positions = dict(self._zeros)
        self._shown_ns = 0
        self._moving = node.create_publisher(TFMessage, TRANSFORMS, TF_QOS)
        self._fixed = node.create_publisher(TFMessage, STATIC_TRANSFORMS, STATIC_TF_PUBLISHER_QOS)
        node.get_logger().info("The recording has no /tf: the robot's transforms are computed from its joint states")

    def wanted(self) -> frozenset[str]:
        """Return the topics of the recording that are needed because they have subscriptions.

        If the transforms have subscriptions, the topics from which they are computed are included.
        """
        topics = self._recording.wanted()
        if self._moving.get_subscription_count():
            topics |= {topic for topic in (self._description, self._joint_states) if topic is not None}
        return topics

    def publish_time(self, stamp_ns: int) -> None:
        """Publish a time on ``/clock``."""
        self._recording.publish_time(stamp_ns)

    def publish(self, topic: str, stamp_ns: int, data: bytes) -> None:
        """Publish a message, and the transforms that the message changes."""
        self._recording.publish(topic, stamp_ns, data)
        if stamp_ns < self._shown_ns:
            self._positions = dict(self._zeros)
        self._shown_ns = stamp_ns
        if topic == self._description:
            self._fixed.publish(TFMessage(batch=self._transforms.fixed(stamp_ns)))
            if self._joint_states is None:
                self._place(stamp_ns)
        elif topic == self._joint_states:
            states = deserialize(data, JointState)
            self._positions.update(zip(states.name, states.position, strict=False))
            self._place(states.header.stamp.nanoseconds or stamp_ns)

    def _place(self, stamp_ns: int) -> None:
        batch = self._transforms.recipe(tuple(self._positions)).batch(list(self._positions.values()), stamp_ns)
        if len(batch):
            self._moving.publish(TFMessage(batch=batch))


def published(bag: BagReader, node: Node, robot: Robot | None) -> PublishedRecording | PlacedRobot:
    """Return the object that publishes a recording in a graph of its own.

    Args:
        bag: the recording.
        node: the node that publishes.
        robot: the robot that `robot_of` returned, or None.
    """
    namespace = namespace_of_transforms(bag)
    recording = PublishedRecording(node, bag, namespace)
    if namespace:
        node.get_logger().info(f"The recording has no /tf: {namespace}{TRANSFORMS} replaces it")
    return PlacedRobot(recording, node, bag, robot) if robot is not None and lacks_transforms(bag) else recording


def _zeros(robot: Robot) -> dict[str, float]:
    try:
        return {joint.name: joint.zero for joint in layout_of(robot, JointSettings()).free}
    except LinkwrightError:  # joints mimic one another in a cycle, so their positions are not computed
        return {}
