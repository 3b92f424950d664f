"""A graph for tests of nodes: it starts them, and records their messages."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import (
    DESCRIPTION_QOS,
    STATIC_TF_SUBSCRIPTION_QOS,
    TF_QOS,
    Graph,
    JumpClock,
    LogRecord,
    Parameter,
    TransformBuffer,
    TransformListener,
)
from linkwright.messages import Header, JointState, String, TFMessage, Time
from linkwright.nodes import NodeOptions
from linkwright.nodes.joint_state_publisher import JointStatePublisher
from linkwright.nodes.joint_state_publisher_gui import JointStatePublisherGui
from linkwright.nodes.robot_state_publisher import RobotStatePublisher


def joint(
    name: str,
    kind: str = "revolute",
    *,
    parent: str = "base",
    child: str | None = None,
    limit: str | None = "lower='-1' upper='2'",
    content: str = "",
    xyz: str = "0 0 0",
    axis: str = "0 0 1",
) -> str:
    """Return a joint and its child link, which by default has the joint's name."""
    child = child or f"{name}_link"
    needs_limit = kind in ("revolute", "prismatic") and limit is not None
    return (
        f"<link name='{child}'/><joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>"
        f"<origin xyz='{xyz}'/><axis xyz='{axis}'/>"
        + (f"<limit {limit} effort='1' velocity='1'/>" if needs_limit else "")
        + f"{content}</joint>"
    )


def robot(*joints: str) -> str:
    """Return a robot with a link ``base`` and these joints."""
    return f"<robot name='test'><link name='base'/>{''.join(joints)}</robot>"


def mimic(master: str, attributes: str = "") -> str:
    """Return a mimic tag."""
    return f"<mimic joint='{master}' {attributes}/>"


class NodeHarness:
    def __init__(self, graph: Graph, clock: JumpClock, log: list[LogRecord]) -> None:
        self.graph, self.clock, self.log = graph, clock, log
        self.library = DescriptionLibrary()
        self.node = graph.create_node("test_node")
        self.tf: list[TFMessage] = []
        self.tf_static: list[TFMessage] = []
        self.descriptions: list[str] = []
        self.joint_states: list[JointState] = []
        self.node.create_subscription(TFMessage, "/tf", self.tf.append, TF_QOS)
        self.node.create_subscription(TFMessage, "/tf_static", self.tf_static.append, STATIC_TF_SUBSCRIPTION_QOS)
        self.node.create_subscription(
            String, "robot_description", lambda message: self.descriptions.append(message.data), DESCRIPTION_QOS
        )
        self.node.create_subscription(JointState, "joint_states", self.joint_states.append, 100)
        self.buffer = TransformBuffer()
        TransformListener(self.buffer, self.node)
        self._joint_states = self.node.create_publisher(JointState, "joint_states", 100)
        self._descriptions = self.node.create_publisher(String, "robot_description", DESCRIPTION_QOS)

    def options(self, parameters: dict[str, Any], **options: Any) -> NodeOptions:
        return NodeOptions(parameters=parameters, library=self.library, **options)

    def robot_state_publisher(self, text: str, **parameters: Any) -> RobotStatePublisher:
        return RobotStatePublisher(self.graph, self.options({"robot_description": text, **parameters}))

    def joint_state_publisher(self, **parameters: Any) -> JointStatePublisher:
        return JointStatePublisher(self.graph, self.options(parameters))

    def gui(self, **parameters: Any) -> JointStatePublisherGui:
        return JointStatePublisherGui(self.graph, self.options(parameters))

    async def describe(self, text: str) -> None:
        self._descriptions.publish(String(data=text))
        await self.graph.settle()

    async def move(self, positions: dict[str, float], *, stamp_ns: int | None = None) -> None:
        """Publish joint states, by default with the current time."""
        stamp = Time.from_nanoseconds(self.clock.now_ns() if stamp_ns is None else stamp_ns)
        self._joint_states.publish(
            JointState(header=Header(stamp=stamp), name=list(positions), position=list(positions.values()))
        )
        await self.graph.settle()

    async def send(self, message: JointState) -> None:
        self._joint_states.publish(message)
        await self.graph.settle()

    async def set(self, node: Any, **values: Any) -> list[tuple[bool, str]]:
        results = node.node.set_parameters([Parameter(name, value=value) for name, value in values.items()])
        await self.graph.settle()
        return [(result.successful, result.reason) for result in results]

    def moved_frames(self) -> list[list[str]]:
        """Return the child frames of each message on ``/tf``."""
        return [sorted(message.batch.children) for message in self.tf]

    def positions(self) -> dict[str, float]:
        """Return the positions in the last joint states."""
        message: JointState = self.joint_states[-1]
        values: Sequence[float] = list(message.position)
        return dict(zip(message.name, values, strict=True))
