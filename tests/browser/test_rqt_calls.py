"""The panels that replace the programs of rqt for services, publishers, controllers and trajectories."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from tests.browser.conftest import Start

pytestmark = pytest.mark.browser

ROBOT = """<robot name='r'><link name='base'/><link name='arm'/><joint name='elbow' type='revolute'>
<parent link='base'/><child link='arm'/><axis xyz='0 0 1'/><limit lower='-1' upper='2' effort='1' velocity='2'/></joint>
<ros2_control name='mock' type='system'><hardware><plugin>mock_components/GenericSystem</plugin></hardware>
<joint name='elbow'><command_interface name='position'/><state_interface name='position'/>
<state_interface name='velocity'/></joint></ros2_control></robot>"""
CONTROLLERS = """\
controller_manager:
  ros__parameters:
    update_rate: 50
    jsb: {type: joint_state_broadcaster/JointStateBroadcaster}
    arm: {type: joint_trajectory_controller/JointTrajectoryController}
    spare: {type: forward_command_controller/ForwardCommandController}
arm:
  ros__parameters: {joints: [elbow], command_interfaces: [position], state_interfaces: [position, velocity]}
spare:
  ros__parameters: {joints: [elbow], interface_name: position}
"""
LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    rqt = [Node(package=name, executable=name) for name in (
        'rqt_service_caller', 'rqt_publisher', 'rqt_joint_trajectory_controller', 'rqt_controller_manager')]
    return LaunchDescription([
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': open('ROBOT').read()}]),
        Node(package='controller_manager', executable='ros2_control_node', parameters=['CONTROLLERS']),
        Node(package='controller_manager', executable='spawner', arguments=['jsb', 'arm']),
        *rqt,
    ])
"""


@pytest.fixture
def page(start: Start, open_page: Callable[..., Page], tmp_path: Path) -> Page:
    """Return the page of a launch with a controlled robot and the programs."""
    (tmp_path / "robot.urdf").write_text(ROBOT)
    (tmp_path / "controllers.yaml").write_text(CONTROLLERS)
    launch = LAUNCH.replace("ROBOT", str(tmp_path / "robot.urdf"))
    (tmp_path / "arm.launch.py").write_text(launch.replace("CONTROLLERS", str(tmp_path / "controllers.yaml")))
    return open_page(start("launch", str(tmp_path / "arm.launch.py")), wait=False)


def show(page: Page, title: str) -> None:
    page.locator(".panel-tab", has_text=title).click()


def test_panels_of_rqt_programs_control_the_robot(page: Page) -> None:
    row = page.locator("tr[data-controller='arm']")
    expect(row.locator(".controller-state")).to_have_text("active", timeout=20_000)
    expect(page.locator("tr[data-controller='spare'] .controller-state")).to_have_text("not loaded")
    page.locator("tr[data-controller='spare']").get_by_role("button", name="Load", exact=True).click()
    expect(page.locator("tr[data-controller='spare'] .controller-state")).to_have_text("unconfigured")
    expect(page.locator("tr[data-controller='mock'] .controller-state")).to_have_text("active")

    show(page, "Joint trajectory")
    page.get_by_text("Move the robot").click()
    field = page.locator("[data-joint='elbow'] .field")
    field.fill("1.25")
    field.press("Enter")
    expect(page.locator("[data-joint='elbow'] output")).to_have_text("1.250", timeout=10_000)

    show(page, "Services")
    page.get_by_role("combobox", name="Service").fill("/controller_manager/list_controller_types")
    page.get_by_role("button", name="Call").click()
    expect(page.locator(".call-response")).to_contain_text("Response after")
    expect(page.locator(".call-response .message-name").first).to_have_text("types")

    show(page, "Publisher")
    page.get_by_role("combobox", name="Topic").fill("/speed")
    page.get_by_placeholder("Type").fill("std_msgs/msg/Float64")
    page.get_by_title("Add a publisher").click()
    text = page.get_by_role("textbox", name="Message of /speed")
    expect(text).to_have_value("data: 0.0\n")
    text.fill("data: 2.5")
    page.locator(".publisher .tick").click()
    expect(page.locator(".publisher")).to_contain_text("published: 3")
    text.fill("speed: 2.5")
    expect(page.locator(".publisher [role='alert']")).to_contain_text("speed")
