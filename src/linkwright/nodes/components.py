"""The nodes that can be composed: package and plugin name to what starts one in a container's process."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from linkwright.nodes.options import Factory, NodeOptions, RunningNode

if TYPE_CHECKING:
    from linkwright.graph import Graph

_PLACE = {"translation": ("x", "y", "z"), "rotation": ("x", "y", "z", "w")}


def _robot_state_publisher(graph: Graph, options: NodeOptions) -> RunningNode:
    from linkwright.nodes.robot_state_publisher import RobotStatePublisher

    return RobotStatePublisher(graph, options)


def _joint_state_publisher(graph: Graph, options: NodeOptions) -> RunningNode:
    from linkwright.nodes.joint_state_publisher import JointStatePublisher

    return JointStatePublisher(graph, options)


def _static_transform_broadcaster(graph: Graph, options: NodeOptions) -> RunningNode:
    """tf2_ros' component, which is told by parameters what the executable is told by arguments."""
    from linkwright.nodes.static_transform_publisher import StaticTransformPublisher

    given: dict[str, Any] = options.parameters
    words: list[str] = []
    for group, axes in _PLACE.items():
        for axis in axes:
            name = f"{group}.{axis}"
            if name in given:
                words += [f"--{'q' if group == 'rotation' else ''}{axis}", str(given.pop(name))]
    words += [
        "--frame-id",
        str(given.pop("frame_id", "/frame")),
        "--child-frame-id",
        str(given.pop("child_frame_id", "/child")),
    ]
    options.arguments = [*words, *options.arguments]
    return StaticTransformPublisher(graph, options)


def _talker(graph: Graph, options: NodeOptions) -> RunningNode:
    from linkwright.nodes.demo_talker import Talker

    return Talker(graph, options)


def _listener(graph: Graph, options: NodeOptions) -> RunningNode:
    from linkwright.nodes.demo_listener import Listener

    return Listener(graph, options)


COMPONENTS: Mapping[tuple[str, str], Factory] = {
    ("robot_state_publisher", "robot_state_publisher::RobotStatePublisher"): _robot_state_publisher,
    ("joint_state_publisher", "joint_state_publisher::JointStatePublisher"): _joint_state_publisher,
    ("tf2_ros", "tf2_ros::StaticTransformBroadcasterNode"): _static_transform_broadcaster,
    ("composition", "composition::Talker"): _talker,
    ("composition", "composition::Listener"): _listener,
    ("demo_nodes_cpp", "demo_nodes_cpp::Talker"): _talker,
    ("demo_nodes_cpp", "demo_nodes_cpp::Listener"): _listener,
}
