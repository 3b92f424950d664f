"""The MotionPlanning display and panel in a real browser, with move_group on the same graph."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from linkwright.graph import DESCRIPTION_QOS, ActionServer
from linkwright.messages import get_action, get_message
from linkwright.nodes import NodeOptions
from linkwright.planning.nodes.move_group import MoveGroup
from tests.browser.axe import find_violations
from tests.browser.conftest import POLL_PERIOD_S, TIMEOUT_S, until
from tests.browser.live import LiveViewer, configuration
from tests.planning.arms import urdf
from tests.planning.nodes.test_move_group import PARAMETERS, START
from tests.waiting import wait_until

pytestmark = [pytest.mark.browser, pytest.mark.extra("arm")]

DISTANCE, PITCH, YAW = 4.0, 1.2, -1.5708
FIELD_OF_VIEW = math.radians(45.0)
CONFIGURATION = configuration(
    """
- {Class: rviz_default_plugins/Grid, Enabled: true, Name: Grid}
- Class: moveit_rviz_plugin/MotionPlanning
  Enabled: true
  Name: MotionPlanning
""",
    distance=DISTANCE,
    pitch=PITCH,
    yaw=YAW,
)
DRAWN = "lw.displays[1]?.drawn"
HANDLE = f"{DRAWN}?.handles?.['goal tool']"
RESULT = "document.querySelector('.planning-result')?.textContent"
NOTE = "document.querySelector('.planning-tab > .note')?.textContent"


class Arm:
    """move_group and the controller of the test arm, in the graph of a viewer."""

    def __init__(self, viewer: LiveViewer) -> None:
        self._viewer = viewer
        description = get_message("std_msgs/msg/String")(data=_draw_collisions())
        viewer.publish("/robot_description", description, DESCRIPTION_QOS)
        viewer.run(self._start)
        self.publish_joints(**START)

    def publish_joints(self, **joints: float) -> None:
        message = get_message("sensor_msgs/msg/JointState")()
        message.name, message.position = list(joints), list(joints.values())
        self._viewer.publish("/joint_states", message)

    def close(self) -> None:
        self._viewer.run(self.move_group.close)

    def _start(self) -> None:
        node = self._viewer.node
        self.move_group = MoveGroup(self._viewer._graph, NodeOptions(parameters=PARAMETERS))
        self._states = node.create_publisher("sensor_msgs/msg/JointState", "/joint_states", 10)
        self._server = ActionServer(
            node,
            "control_msgs/action/FollowJointTrajectory",
            "/arm_controller/follow_joint_trajectory",
            self._follow,
        )

    def _follow(self, goal: Any) -> Any:
        trajectory = goal.request.trajectory
        message = get_message("sensor_msgs/msg/JointState")()
        message.name, message.position = trajectory.joint_names, trajectory.points[-1].positions
        self._states.publish(message)
        goal.succeed()
        return get_action("control_msgs/action/FollowJointTrajectory").Result()


def _draw_collisions() -> str:
    """Return the URDF of the test arm, in which collision shapes are drawn."""
    return urdf().replace("<collision>", "<visual>").replace("</collision>", "</visual>")


@pytest.fixture
def planning(start_viewer, open_page) -> Iterator[tuple[LiveViewer, Any]]:
    """Return a viewer and its page, after the handle and the panel appeared."""
    viewer = start_viewer(CONFIGURATION)
    arm = Arm(viewer)
    page = open_page(viewer, wait=False)
    until(page, f"{HANDLE} !== undefined && {RESULT}?.startsWith('Drag')")
    until(page, f"{DRAWN}?.markers?.['Goal State/palm'] !== undefined && lw.tools.length > 0")
    page.keyboard.press("i")
    until(page, "lw.tool.class.endsWith('/Interact')")
    viewer.settle(page)
    yield viewer, page
    arm.close()


def find_on_screen(page: Any, point: list[float]) -> tuple[float, float]:
    """Return the pixel of a point in the Fixed Frame."""
    away = np.array([math.cos(PITCH) * math.cos(YAW), math.cos(PITCH) * math.sin(YAW), math.sin(PITCH)])
    right = np.cross((0.0, 0.0, 1.0), away)
    right /= np.linalg.norm(right)
    up = np.cross(away, right)
    depth = DISTANCE - np.dot(away, point)
    box = page.locator(".canvas-box canvas").bounding_box()
    scale = box["height"] / (2.0 * math.tan(FIELD_OF_VIEW / 2.0) * depth)
    return (
        box["x"] + box["width"] / 2 + scale * float(np.dot(right, point)),
        box["y"] + box["height"] / 2 - scale * float(np.dot(up, point)),
    )


def read_position(page: Any, handle: str = HANDLE) -> list[float]:
    return page.evaluate(f"() => {{ const lw = window.linkwright; return {handle}.pose.slice(0, 3); }}")


def drag_until(page: Any, dx: float, dy: float, condition: str, handle: str = HANDLE) -> None:
    """Hold the ball of a handle, and move the mouse by at most this many pixels, until a condition holds."""
    x, y = find_on_screen(page, read_position(page, handle))
    page.mouse.move(x, y)
    until(page, "lw.tool.hint.includes('Drag: move')")
    page.mouse.down()
    step = 0

    def is_reached() -> bool:
        nonlocal step
        step = min(step + 1, 20)
        page.mouse.move(x + dx * step / 20, y + dy * step / 20 + (step % 2))
        return page.evaluate(f"() => {{ const lw = window.linkwright; return Boolean({condition}); }}")

    wait_until(is_reached, TIMEOUT_S, pause=POLL_PERIOD_S)


def test_goal_is_dragged_planned_and_executed(planning, tmp_path):
    _, page = planning
    start = read_position(page)
    drag_until(page, -60, 60, f"{NOTE} === '' && document.querySelectorAll('.planning-row select')[2].value === ''")
    page.mouse.up()
    until(page, f"Math.hypot({HANDLE}.pose[0] - {start[0]}, {HANDLE}.pose[1] - {start[1]}) > 0.02")
    page.get_by_role("button", name="Plan", exact=True).click()
    until(page, f"{RESULT}.startsWith('Planned in')")
    until(page, f"{DRAWN}.markers['Planned Path/palm'] !== undefined")
    page.get_by_role("button", name="Execute", exact=True).click()
    until(page, f"{RESULT} === 'The motion was executed.'")
    page.get_by_label("Goal State", exact=True).select_option("ready")
    page.get_by_role("button", name="Plan & Execute").click()
    until(page, f"{RESULT} === 'The motion was executed.'")
    page.screenshot(path=tmp_path / "planning.png")


def test_unreachable_handle_is_red_and_returns(planning, tmp_path):
    _, page = planning
    start = read_position(page)
    drag_until(page, 350, 200, f"{HANDLE}.wrong && {NOTE} === 'The pose of the handle cannot be reached.'")
    page.screenshot(path=tmp_path / "unreachable.png")
    page.mouse.up()
    until(page, f"!{HANDLE}.wrong && {NOTE} === ''")
    assert math.dist(read_position(page), start) < 1.0


def test_panel_passes_axe_and_stores_settings(planning):
    viewer, page = planning
    field = page.get_by_label("Velocity Scaling", exact=True)
    field.fill("0.5")
    field.press("Enter")
    display = viewer.viewer.displays[1]
    wait_until(lambda: viewer.run(lambda: display.properties.number("Velocity_Scaling_Factor")) == 0.5, TIMEOUT_S)
    page.get_by_label("Pipeline", exact=True).select_option("pilz_industrial_motion_planner")
    page.get_by_label("Planner", exact=True).select_option("LIN")
    until(page, "document.querySelectorAll('.planning-row select')[4].value === 'LIN'")
    assert find_violations(page, ".planning-panel") == []


def test_joint_slider_moves_goal(planning):
    _, page = planning
    page.get_by_role("tab", name="Joints").click()
    field = page.get_by_label("Position of pan")
    field.fill("0.8")
    field.press("Enter")
    until(page, f"Math.abs({HANDLE}.pose[1]) > 0.2")
    assert find_violations(page, ".planning-panel") == []
    page.get_by_role("tab", name="Joints").press("ArrowLeft")
    until(page, "document.querySelectorAll('.planning-row select')[2].value === ''")


def test_scene_object_is_added_moved_and_attached(planning, tmp_path):
    viewer, page = planning
    panel = page.locator(".planning-panel")
    panel.get_by_role("tab", name="Scene Objects").click()
    panel.get_by_label("Shape", exact=True).select_option("sphere")
    panel.get_by_role("button", name="Add", exact=True).click()
    until(page, f"{DRAWN}.markers['Scene Geometry/sphere_1'] === 'sphere'")
    panel.get_by_label("Pose: Y", exact=True).fill("-0.4")
    panel.get_by_label("Pose: Y", exact=True).press("Enter")
    scene = viewer.viewer.displays[1].scene
    wait_until(lambda: viewer.run(lambda: scene.objects["sphere_1"].pose.position.y) == -0.4, TIMEOUT_S)
    assert find_violations(page, ".planning-panel") == []
    panel.get_by_label("Link", exact=True).select_option("tool")
    panel.get_by_role("button", name="Attach").click()
    until(page, f"{DRAWN}.markers['Scene Robot holds/sphere_1'] === 'sphere'")
    page.screenshot(path=tmp_path / "objects.png")
    panel.get_by_role("button", name="Detach").click()
    until(page, f"{DRAWN}.markers['Scene Geometry/sphere_1'] === 'sphere'")
    panel.get_by_role("button", name="Remove").click()
    until(page, f"{DRAWN}.markers['Scene Geometry/sphere_1'] === undefined")


def test_selected_object_is_dragged_while_its_tab_is_open(planning, tmp_path):
    viewer, page = planning
    handle = f"{DRAWN}?.handles?.['object box_1']"
    panel = page.locator(".planning-panel")
    panel.get_by_role("tab", name="Scene Objects").click()
    panel.get_by_role("button", name="Add", exact=True).click()
    until(page, f"{handle} !== undefined")
    viewer.settle(page)
    start = read_position(page, handle)
    drag_until(page, 80, 50, f"Math.hypot({handle}.pose[0] - {start[0]}, {handle}.pose[1] - {start[1]}) > 0.1", handle)
    page.screenshot(path=tmp_path / "object.png")
    page.mouse.up()
    scene = viewer.viewer.displays[1].scene

    def is_object_at_handle() -> bool:
        position = viewer.run(lambda: scene.objects["box_1"].pose.position)
        return math.dist((position.x, position.y, position.z), read_position(page, handle)) < 1e-3

    wait_until(is_object_at_handle, TIMEOUT_S)
    assert math.dist(read_position(page, handle), start) > 0.1
    panel.get_by_role("tab", name="Joints").click()
    until(page, f"{handle} === undefined && {HANDLE} !== undefined")


def test_panel_without_a_handle_does_not_ask_to_drag_it(planning, tmp_path):
    viewer, page = planning
    display = viewer.viewer.displays[1]
    viewer.run(lambda: display.set_property(("Planning Request", "Query Goal State"), False))
    until(page, f"{HANDLE} === undefined && {RESULT} === 'Choose a goal state, or move its joints in the tab Joints.'")
    page.screenshot(path=tmp_path / "without.png")
