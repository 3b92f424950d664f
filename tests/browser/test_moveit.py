"""Displays of MoveIt in a real browser."""

from __future__ import annotations

import math
import struct

import pytest

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import get_message
from tests.browser.conftest import until
from tests.browser.live import configuration
from tests.browser.test_markers import CUBE_STL
from tests.rviz.displays.moveit.arm import (
    ARM,
    SolidPrimitive,
    as_signed_bytes,
    make_attached_object,
    make_collision_object,
    make_pose,
    make_primitive,
    make_robot_state,
    make_scene,
    make_trajectory,
)

pytestmark = pytest.mark.browser

String = get_message("std_msgs/msg/String")
MOTION_PLANNING = configuration(
    """
- {Class: rviz_default_plugins/Grid, Enabled: true, Name: Grid}
- Class: moveit_rviz_plugin/MotionPlanning
  Enabled: true
  Name: MotionPlanning
  Planned Path:
    State Display Time: {time}
    Loop Animation: {loop}
    Show Trail: true
""".replace("{time}", "0.05s").replace("{loop}", "true"),
    distance=7,
)


def make_kitchen_scene(*, wrist: float = 0.2):
    """Return a scene with a table, a ball, a cone, an octomap, and a cup in the hand."""
    robot = make_robot_state(shoulder=0.3, wrist=wrist)
    cylinder = make_primitive(SolidPrimitive.CYLINDER, 0.3, 0.08)
    robot.attached_collision_objects = [
        make_attached_object(
            "hand",
            make_collision_object("cup", cylinder, frame="hand", object_pose=make_pose(z=0.25)),
        )
    ]
    kitchen_scene = make_scene(
        make_collision_object(
            "table", make_primitive(SolidPrimitive.BOX, 1.0, 2.0, 0.05), object_pose=make_pose(x=1.6, z=0.4)
        ),
        make_collision_object(
            "ball", make_primitive(SolidPrimitive.SPHERE, 0.2), object_pose=make_pose(x=1.6, y=0.5, z=0.63)
        ),
        make_collision_object(
            "cone", make_primitive(SolidPrimitive.CONE, 0.5, 0.2), object_pose=make_pose(x=1.6, y=-0.5, z=0.68)
        ),
        robot=robot,
    )
    octomap = kitchen_scene.world.octomap
    octomap.header.frame_id, octomap.origin = "base", make_pose(x=-1.0, y=-1.0)
    octomap.octomap.id, octomap.octomap.binary, octomap.octomap.resolution = "OcTree", True, 0.1
    inner_node, leaf_node = struct.pack("<H", 0xFFFF), struct.pack("<H", 0xAAAA)
    octree_data = struct.pack("<H", 3 << 14) + struct.pack("<H", 3) * 12
    octomap.octomap.data = as_signed_bytes(octree_data + inner_node + (inner_node + leaf_node * 8) * 8)
    return kitchen_scene


def test_planning_scene_and_trajectory_are_drawn(start_viewer, open_page, tmp_path):
    (tmp_path / "hand.stl").write_bytes(CUBE_STL)
    mesh = f'<mesh filename="{(tmp_path / "hand.stl").as_uri()}" scale="0.2 0.2 0.2"/>'
    viewer = start_viewer(MOTION_PLANNING)
    viewer.publish("/robot_description", String(data=ARM.replace('<sphere radius="0.1"/>', mesh)), DESCRIPTION_QOS)
    page = open_page(viewer, wait=False)
    viewer.publish("/monitored_planning_scene", make_kitchen_scene())
    markers = "lw.displays[1]?.drawn?.markers"
    until(
        page,
        f"{markers}?.['Scene Geometry/table'] === 'cube' && {markers}?.['Scene Geometry/octomap 0.1'] === 'cube_list'",
    )
    until(
        page,
        f"{markers}?.['Scene Robot/hand'] === 'mesh' && {markers}?.['Scene Robot holds/cup'] === 'cylinder'",
    )
    viewer.publish("/display_planned_path", make_trajectory(*(0.1 * step for step in range(15))))
    until(
        page,
        f"{markers}?.['Planned Path/hand'] === 'mesh' && {markers}?.['Goal State/upper'] === 'cylinder'",
    )
    until(page, f"{markers}?.['Planned Path 15/upper'] === 'cylinder'")
    page.screenshot(path=tmp_path / "moveit.png")
    assert viewer.run(lambda: [row.text for row in viewer.viewer.displays[1].status if row.level != "ok"]) == []


def test_moving_mesh_is_not_reloaded(start_viewer, open_page, tmp_path):
    (tmp_path / "hand.stl").write_bytes(CUBE_STL)
    mesh = f'<mesh filename="{(tmp_path / "hand.stl").as_uri()}"/>'
    viewer = start_viewer(configuration("- {Class: moveit_rviz_plugin/PlanningScene, Enabled: true, Name: Scene}"))
    viewer.publish("/robot_description", String(data=ARM.replace('<sphere radius="0.1"/>', mesh)), DESCRIPTION_QOS)
    page = open_page(viewer, wait=False)
    viewer.publish("/monitored_planning_scene", make_scene(robot=make_robot_state(shoulder=0.0)))
    until(
        page,
        "lw.displays[0]?.drawn?.markers?.['Scene Robot/hand'] === 'mesh' && "
        "lw.displays[0].drawn.bounds?.[1]?.[2] > 0.9",
    )
    loads = "performance.getEntriesByType('resource').filter((resource) => resource.name.includes('.stl')).length"
    until(page, f"{loads} === 1")
    viewer.publish("/monitored_planning_scene", make_scene(robot=make_robot_state(shoulder=math.pi), diff=True))
    until(page, "lw.displays[0]?.drawn?.bounds?.[0]?.[2] < -0.9")
    assert page.evaluate(loads) == 1


def test_missing_mesh_is_reported(start_viewer, open_page):
    viewer = start_viewer(configuration("- {Class: moveit_rviz_plugin/PlanningScene, Enabled: true, Name: Scene}"))
    text = ARM.replace('<sphere radius="0.1"/>', '<mesh filename="file:///nowhere/hand.stl"/>')
    viewer.publish("/robot_description", String(data=text), DESCRIPTION_QOS)
    page = open_page(viewer, wait=False)
    viewer.publish("/monitored_planning_scene", make_scene(robot=make_robot_state(shoulder=0.0)))
    until(page, "lw.displays[0]?.drawn?.markers?.['Scene Robot/upper'] === 'cylinder'")
    until(page, "lw.displays[0]?.status.some((row) => row.name === 'hand' && row.text.includes('no file'))")
