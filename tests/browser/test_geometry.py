"""Geometry displays in a real browser, and the rows of TF and the robot.

The tests cover poses, paths, polygons, ranges, vectors and efforts.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import String, get_message
from tests.browser.conftest import state, until, wait_until_equal
from tests.browser.live import configuration
from tests.rviz.displays.test_geometry_displays import make_message, make_pose

pytestmark = pytest.mark.browser

JointState = get_message("sensor_msgs/msg/JointState")

DISPLAYS = configuration(
    """
- {Class: rviz_default_plugins/Pose, Enabled: true, Name: Pose, Topic: {Value: /pose}}
- {Class: rviz_default_plugins/PoseWithCovariance, Enabled: true, Name: Guess, Topic: {Value: /guess}}
- {Class: rviz_default_plugins/PoseArray, Enabled: true, Name: Cloud, Topic: {Value: /cloud}}
- {Class: nav2_rviz_plugins/ParticleCloud, Enabled: true, Name: Particles, Topic: {Value: /particle_cloud}}
- {Class: rviz_default_plugins/Odometry, Enabled: true, Name: Way, Topic: {Value: /odom}}
- {Class: rviz_default_plugins/Path, Enabled: true, Name: Plan, Topic: {Value: /plan}, Line Style: Billboards,
   Line Width: 0.1, Pose Style: Axes}
- {Class: rviz_default_plugins/Polygon, Enabled: true, Name: Field, Topic: {Value: /field}}
- {Class: rviz_default_plugins/Range, Enabled: true, Name: Sonar, Topic: {Value: /sonar}}
- {Class: rviz_default_plugins/TwistStamped, Enabled: true, Name: Speed, Topic: {Value: /speed}}
- {Class: rviz_default_plugins/Wrench, Enabled: true, Name: Push, Topic: {Value: /push}}
- {Class: rviz_default_plugins/Effort, Enabled: true, Name: Torque, Topic: {Value: /joint_states}}
- {Class: rviz_default_plugins/PointStamped, Enabled: true, Name: Click, Topic: {Value: /click}}
- {Class: rviz_default_plugins/Axes, Enabled: true, Name: Axes, Reference Frame: tip}
""",
    distance=12.0,
)
CRANE = """\
<robot name="crane">
  <link name="base">
    <visual><geometry><box size="1 1 0.1"/></geometry></visual>
    <inertial><origin xyz="0 0 1"/><mass value="20"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="tip"><visual><geometry><box size="0.1 0.1 1"/></geometry></visual></link>
  <joint name="lift" type="revolute"><parent link="base"/><child link="tip"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="2" effort="10" velocity="1"/></joint>
</robot>
"""


def publish_all(viewer) -> None:
    """Publish a message for each display; the frame ``tip`` is one meter above ``base``."""
    viewer.place("tip", 0.0, 0.0, 1.0)
    viewer.publish("/robot_description", String(data=CRANE), DESCRIPTION_QOS)
    viewer.publish("/pose", make_message("geometry_msgs/msg/PoseStamped", pose=make_pose(1)))
    pose_estimate = make_message("geometry_msgs/msg/PoseWithCovarianceStamped")
    pose_estimate.pose.pose = make_pose(0, 2)
    pose_estimate.pose.covariance = np.diag([0.25, 0.04, 0.01, 0.01, 0.01, 0.01]).ravel()
    viewer.publish("/guess", pose_estimate)
    viewer.publish("/cloud", make_message("geometry_msgs/msg/PoseArray", poses=[make_pose(x) for x in range(5)]))
    particle = get_message("nav2_msgs/msg/Particle")
    particles = [particle(pose=make_pose(0), weight=0.0), particle(pose=make_pose(1), weight=0.5)]
    viewer.publish("/particle_cloud", make_message("nav2_msgs/msg/ParticleCloud", particles=particles))
    for x in (0, 1, 2):
        odometry = make_message("nav_msgs/msg/Odometry")
        odometry.pose.pose = make_pose(x, -2)
        viewer.publish("/odom", odometry)
    poses = [make_message("geometry_msgs/msg/PoseStamped", pose=make_pose(x, 3)) for x in range(4)]
    viewer.publish("/plan", make_message("nav_msgs/msg/Path", poses=poses))
    field = make_message("geometry_msgs/msg/PolygonStamped")
    corner = get_message("geometry_msgs/msg/Point32")
    field.polygon.points = [corner(x=x, y=y, z=0.0) for x, y in ((-3.0, -3.0), (-1.0, -3.0), (-1.0, -1.0))]
    viewer.publish("/field", field)
    sonar = make_message("sensor_msgs/msg/Range", range=2.0, min_range=0.1, max_range=4.0, field_of_view=math.pi / 2)
    viewer.publish("/sonar", sonar)
    velocity = make_message("geometry_msgs/msg/TwistStamped")
    velocity.twist.linear.x, velocity.twist.angular.z = 1.0, 0.1
    viewer.publish("/speed", velocity)
    push = make_message("geometry_msgs/msg/WrenchStamped")
    push.wrench.torque.z = 1.0
    viewer.publish("/push", push)
    viewer.publish("/joint_states", JointState(name=["lift"], position=[0.0], effort=[10.0]))
    click = make_message("geometry_msgs/msg/PointStamped")
    click.point.z = 1.0
    viewer.publish("/click", click)


def drawings(page) -> dict[str, dict]:
    return {display["name"]: display["drawn"] for display in state(page, "displays")}


def drawn_size(drawing: dict) -> list[float]:
    return [high - low for low, high in zip(drawing["bounds"]["min"], drawing["bounds"]["max"], strict=True)]


def test_displays_draw_their_messages_at_the_right_pose(start_viewer, open_page):
    viewer = start_viewer(DISPLAYS)
    publish_all(viewer)
    page = open_page(viewer, wait=False)
    until(page, "lw.displays.every((display) => display.drawn?.bounds)")
    viewer.settle(page)
    drawing = drawings(page)
    assert drawing["Pose"]["bounds"]["min"] == pytest.approx([1, -0.05, 0.95], abs=1e-3)
    assert drawing["Pose"]["bounds"]["max"] == pytest.approx([2.3, 0.05, 1.05], abs=1e-3)
    assert drawing["Guess"]["bounds"]["max"] == pytest.approx([1.3, 3.001, 2.001], abs=0.02)
    assert (drawing["Cloud"]["arrows"], drawn_size(drawing["Cloud"])[:2]) == (0, pytest.approx([4.3, 0.12], abs=1e-3))
    assert drawing["Particles"]["bounds"]["max"] == pytest.approx([1.16, 0.032, 3.5], abs=1e-3)
    assert (drawing["Way"]["arrows"], drawing["Way"]["contents"]) == (3, 3)
    assert (drawing["Plan"]["points"], drawing["Plan"]["axes"], drawing["Plan"]["wide"]) == (4, 4, True)
    assert drawing["Plan"]["bounds"]["max"] == pytest.approx([3.3, 3.3, 1.3], abs=1e-3)
    assert drawing["Field"] == {"contents": 1, "corners": 3, "bounds": {"min": [-3, -3, 1], "max": [-1, -1, 1]}}
    assert drawing["Sonar"]["bounds"]["max"] == pytest.approx([2, 2, 3], abs=1e-2)
    assert drawing["Sonar"]["bounds"]["min"][0] == pytest.approx(0, abs=1e-6)
    # The arrow of the angular vector of 0.1 is hidden, because it would not be longer than wide.
    assert (drawing["Speed"]["arrows"], drawing["Push"]["arrows"]) == (1, 2)
    assert drawing["Speed"]["bounds"]["max"][0] == pytest.approx(2.6, abs=1e-3)
    assert drawing["Push"]["bounds"]["max"][2] == pytest.approx(3.6, abs=1e-3)
    assert (drawing["Torque"]["rings"], drawing["Torque"]["efforts"]) == (1, [10])
    assert drawn_size(drawing["Torque"])[1] < 0.2 < drawn_size(drawing["Torque"])[0]
    assert drawn_size(drawing["Click"]) == pytest.approx([0.2] * 3, abs=1e-2)
    assert drawing["Axes"]["bounds"]["max"] == pytest.approx([1, 1, 2], abs=1e-3)
    wait_until_equal(lambda: {display["level"] for display in state(page, "displays")}, {"ok"})


def test_property_changes_and_disabling_act_at_once(start_viewer, open_page):
    viewer = start_viewer(DISPLAYS)
    publish_all(viewer)
    page = open_page(viewer, wait=False)
    until(page, "lw.displays.every((display) => display.drawn?.bounds)")
    viewer.settle(page)

    def change(name: str, path: tuple[str, ...], value: object) -> None:
        def act() -> None:
            display = next(display for display in viewer.viewer.displays if display.config.name == name)
            display.set_property(path, value)

        viewer.run(act)

    change("Pose", ("Shaft Length",), 2.0)
    change("Cloud", ("Shape",), "Arrow (3D)")
    change("Plan", ("Line Style",), "Lines")
    change("Way", ("Shape",), "Axes")
    change("Guess", ("Covariance",), False)
    change("Torque", ("Joints", "lift"), False)
    change("Click", ("Topic",), "/nothing")
    until(page, "lw.displays.find((display) => display.name === 'Click').drawn.points === 0")
    until(page, "lw.displays.find((display) => display.name === 'Torque').drawn.rings === 0")
    until(page, "lw.displays.find((display) => display.name === 'Way').drawn.axes === 3")
    viewer.settle(page)
    drawing = drawings(page)
    assert drawing["Pose"]["bounds"]["max"][0] == pytest.approx(3.3, abs=1e-3)
    assert drawing["Cloud"]["arrows"] == 5
    assert drawing["Plan"]["wide"] is False
    assert (drawing["Way"]["arrows"], drawing["Way"]["axes"]) == (0, 3)
    assert drawing["Guess"]["bounds"]["max"] == pytest.approx([1.3, 2.05, 1.05], abs=1e-3)


def test_tf_filters_limit_drawn_frames(start_viewer, open_page):
    viewer = start_viewer(configuration("- {Class: rviz_default_plugins/TF, Enabled: true, Filter (whitelist): wheel}"))
    for number, name in enumerate(("left_wheel", "right_wheel", "camera")):
        viewer.place(name, 0.0, 0.0, 1.0 + number)
    page = open_page(viewer, wait=False)
    until(page, "lw.displays[0]?.drawn?.axes === 2")

    def change(name: str, value: str) -> None:
        viewer.run(lambda: viewer.viewer.displays[0].set_property((name,), value))

    change("Filter (blacklist)", "^left")
    until(page, "lw.displays[0].drawn.axes === 1")
    change("Filter (whitelist)", "(")
    until(page, "lw.displays[0].drawn.axes === 3")


ROWS = configuration(
    """
- Class: rviz_default_plugins/TF
  Enabled: true
  Name: Frames
  Show Names: true
- Class: rviz_default_plugins/RobotModel
  Enabled: true
  Name: Robot
  Description Topic: {Value: /robot_description}
  Mass Properties: {Inertia: true, Mass: true}
  Links:
    Link Tree Style: Tree of links and joints
    Expand Tree: true
    Expand Link Details: true
    base: {Show Axes: true, Value: true}
  Joints:
    lift: {Show Axes: true, Show Joint Axis: true}
""",
    distance=4.0,
)


def locate_row(page, key: str):
    return page.locator(f'.row[data-key="{key}"]')


def test_tree_rows_of_frames_links_and_joints_match_scene(start_viewer, open_page):
    viewer = start_viewer(ROWS)
    viewer.publish("/robot_description", String(data=CRANE), DESCRIPTION_QOS)
    viewer.place("tip", 0.0, 0.0, 1.0)
    page = open_page(viewer)
    until(page, "lw.displays[0].drawn?.arrows === 1 && lw.displays[1].drawn?.inertias === 1")
    viewer.settle(page)
    frames, robot = (display["drawn"] for display in state(page, "displays"))
    assert (frames["axes"], frames["names"]) == (2, 2)
    assert frames["bounds"]["max"][2] == pytest.approx(1.2, abs=1e-3)
    assert (robot["axes"], robot["jointAxes"], robot["masses"], robot["inertias"]) == (2, 1, 1, 1)
    identities = {display.config.name: display.id for display in viewer.viewer.displays}
    tf, model = identities["Frames"], identities["Robot"]
    for key in (f"{tf}", f"{tf}/Frames", f"{tf}/Frames/tip"):
        locate_row(page, key).locator(".twist").click()

    def value(key: str) -> str:
        result: str = locate_row(page, key).locator(".row-value").inner_text()
        return result

    wait_until_equal(lambda: value(f"{tf}/Frames/tip#Parent"), "base")
    wait_until_equal(lambda: value(f"{tf}/Frames/tip#Relative Position"), "0; 0; 1")
    viewer.place("tip", 0.0, 0.0, 1.5)
    wait_until_equal(lambda: value(f"{tf}/Frames/tip#Relative Position"), "0; 0; 1.5")
    locate_row(page, tf).locator(".twist").click()
    top = locate_row(page, f"{model}/Links")
    assert "Link/Joint Tree" in top.inner_text()
    top.locator(".twist").click()
    locate_row(page, f"{model}/Links/tip").wait_for()
    names = page.locator(".row-title").all_inner_texts()
    tree = names[names.index("Link/Joint Tree") :]
    assert [name for name in tree if name in ("base", "lift", "tip")] == ["base", "lift", "tip"]
    assert "Lower Limit" not in tree
    locate_row(page, f"{model}/Joints/lift#Details").locator(".twist").click()
    wait_until_equal(lambda: value(f"{model}/Joints/lift#Lower Limit"), "-1")
    wait_until_equal(lambda: value(f"{model}/Joints/lift#Joint Axis"), "0; 1; 0")
    wait_until_equal(lambda: value(f"{model}/Links/tip#Position"), "0; 0; 1.5")
