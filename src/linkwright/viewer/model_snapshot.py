"""Takes a snapshot of a model file without a browser."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from typing import TYPE_CHECKING

from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import DESCRIPTION_QOS, STATIC_TF_PUBLISHER_QOS, TF_QOS, Graph, JumpClock
from linkwright.messages import String, TFMessage
from linkwright.nodes.joint_layout import JointSettings, make_layout
from linkwright.nodes.robot_state_publisher import RobotTransforms
from linkwright.packages import PackageFinder
from linkwright.panels.comparison.feature import add_old_robot
from linkwright.panels.export.snapshot import Snapshot, take_configuration_snapshot
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.rviz.config.rviz_config import RvizConfig
from linkwright.rviz.robot import estimate_size, has_visuals
from linkwright.urdf import Robot
from linkwright.viewer.viewer import Viewer

if TYPE_CHECKING:
    from linkwright.descriptions.pairs import Pair

_SNAPSHOT_TIME_NS = NANOSECONDS_PER_SECOND
"""The time of a snapshot, in nanoseconds. No real time, so that the bytes of an export depend only on its files."""


def take_model_snapshot(
    text: str, robot: Robot, library: DescriptionLibrary, finder: PackageFinder, old: OldDescription | None = None
) -> Snapshot:
    """Return a snapshot of a model as `linkwright view` shows it.

    The same files give the same bytes. Joints are at zero, or in the middle of their limits if the limits exclude zero.

    Args:
        text: the description.
        robot: the robot that was read from the text.
        library: stores the description, with the source positions of its elements.
        finder: finds the meshes of the robot.
        old: the description to compare with; None for no comparison.
    """
    return asyncio.run(_take_snapshot(text, robot, library, finder, old))


@dataclass(frozen=True)
class OldDescription:
    """The older of two compared descriptions.

    Attributes:
        pair: the older and the newer description.
        text: the text that identifies the older description in the library.
    """

    pair: Pair
    text: str


async def _take_snapshot(
    text: str, robot: Robot, library: DescriptionLibrary, finder: PackageFinder, old: OldDescription | None
) -> Snapshot:
    graph = Graph(clock=JumpClock(_SNAPSHOT_TIME_NS), on_log=lambda _: None)
    config = RvizConfig.for_model(robot.root, size=estimate_size(robot), frames=not has_visuals(robot, finder))
    if old is not None:
        add_old_robot(config, old.pair.old.title)
    viewer = Viewer(graph, library=library, finder=finder, config=config, title=robot.name)
    viewer.manager.start()
    node = graph.create_node("robot_state_publisher")
    node.create_publisher(String, "robot_description", DESCRIPTION_QOS).publish(String(data=text))
    transforms = RobotTransforms(robot, "")
    layout = make_layout(robot, JointSettings())
    zero_positions = {joint.name: joint.zero for joint in layout.free}
    moving_batch = transforms.find_conversion(list(zero_positions)).batch(
        list(zero_positions.values()), _SNAPSHOT_TIME_NS
    )
    node.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS).publish(
        TFMessage(batch=transforms.fixed_transforms(_SNAPSHOT_TIME_NS))
    )
    node.create_publisher(TFMessage, "/tf", TF_QOS).publish(TFMessage(batch=moving_batch))
    if old is not None:
        old_publisher_node = graph.create_node("old_robot_state_publisher", start_parameter_services=False)
        viewer.attach_comparison(old.pair, old_publisher_node)(old.text)
    await graph.settle()
    try:
        return take_configuration_snapshot(viewer, viewer.manager)
    finally:
        await viewer.close()
        await graph.close()
