"""Takes a snapshot of a model file without a browser."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import DESCRIPTION_QOS, STATIC_TF_PUBLISHER_QOS, TF_QOS, Graph
from linkwright.messages import String, TFMessage
from linkwright.nodes.joint_layout import JointSettings, layout_of
from linkwright.nodes.robot_state_publisher import RobotTransforms
from linkwright.packages import PackageFinder
from linkwright.panels.comparison.feature import show_old
from linkwright.panels.export.snapshot import Snapshot, snapshot_of
from linkwright.rviz.config.rviz_config import RvizConfig
from linkwright.rviz.robot import has_visuals, size_of
from linkwright.urdf import Robot
from linkwright.viewer.viewer import Viewer

if TYPE_CHECKING:
    from linkwright.descriptions.pairs import Pair


def snapshot_of_model(
    text: str, robot: Robot, library: DescriptionLibrary, finder: PackageFinder, old: OldDescription | None = None
) -> Snapshot:
    """Return a snapshot of a model as `linkwright view` shows it.

    Joints are at zero, or as near to it as their limits allow.

    Args:
        text: the description.
        robot: the robot that was read from the text.
        library: has the source positions of the description's elements.
        finder: finds the robot's meshes.
        old: the description to compare with; None for no comparison.
    """
    return asyncio.run(_snapshot(text, robot, library, finder, old))


@dataclass(frozen=True)
class OldDescription:
    """The older of two compared descriptions.

    Attributes:
        pair: the older and the newer description.
        text: the text that identifies the older description in the library.
    """

    pair: Pair
    text: str


async def _snapshot(
    text: str, robot: Robot, library: DescriptionLibrary, finder: PackageFinder, old: OldDescription | None
) -> Snapshot:
    graph = Graph(on_log=lambda _: None)
    config = RvizConfig.for_model(robot.root, size=size_of(robot), frames=not has_visuals(robot, finder))
    if old is not None:
        show_old(config, old.pair.old.title)
    viewer = Viewer(graph, library=library, finder=finder, config=config, title=robot.name)
    viewer.manager.start()
    node = graph.create_node("robot_state_publisher")
    node.create_publisher(String, "robot_description", DESCRIPTION_QOS).publish(String(text))
    now = time.time_ns()
    transforms = RobotTransforms(robot, "")
    layout = layout_of(robot, JointSettings())
    zeros = {joint.name: joint.zero for joint in layout.free}
    moving = transforms.recipe(list(zeros)).batch(list(zeros.values()), now)
    node.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS).publish(
        TFMessage(batch=transforms.fixed(now))
    )
    node.create_publisher(TFMessage, "/tf", TF_QOS).publish(TFMessage(batch=moving))
    if old is not None:
        publisher = graph.create_node("old_robot_state_publisher", start_parameter_services=False)
        viewer.attach_comparison(old.pair, publisher)(old.text)
    await graph.settle()
    try:
        return snapshot_of(viewer, viewer.manager)
    finally:
        await viewer.close()
        await graph.close()
