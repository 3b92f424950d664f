"""Hardware of ros2_control that another simulator than before loads, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import ARM
from tests.review.conftest import breaking

ROBOT = "arm_description/urdf/arm.urdf.xacro"
PART = "arm_description/urdf/hardware.xacro"
REASON = "simulations that start the robot in Gazebo Classic find no controllers"
CONTROL = """<ros2_control name="motors" type="system">
  <hardware><plugin>{plugin}</plugin></hardware>
</ros2_control>"""
CLASSIC, NEW = "gazebo_ros2_control/GazeboSystem", "gz_ros2_control/GazeboSimSystem"


def make_part(content: str) -> str:
    macro = f'<xacro:macro name="hardware" params="side">{content}</xacro:macro>'
    return f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{macro}</robot>'


def make_robot(content: str) -> str:
    return ARM.replace("</robot>", f"{content}</robot>")


@pytest.mark.parametrize(("path", "make_text"), [(ROBOT, make_robot), (PART, make_part)])
@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        (CLASSIC, NEW, True),
        ("ign_ros2_control/IgnitionSystem", NEW, False),
        ("mock_components/GenericSystem", NEW, False),
        (CLASSIC, "mock_components/GenericSystem", False),
    ],
)
def test_hardware_for_another_simulator_is_breaking(package, compare, path, make_text, old, new, is_breaking):
    package.commit({path: make_text(CONTROL.format(plugin=old))})
    package.write({path: make_text(CONTROL.format(plugin=new))})
    result = compare(package)
    reasons = [str(change.reason) for found in result.subjects for change in found.changes if change.reason is not None]
    assert reasons == [REASON] * is_breaking


def test_hardware_that_an_argument_still_chooses_is_not_lost(package, compare):
    argument = '<xacro:arg name="classic" default="false"/>'
    choice = "".join(
        f'<xacro:{tag} value="$(arg classic)">{CONTROL.format(plugin=plugin)}</xacro:{tag}>'
        for tag, plugin in (("if", CLASSIC), ("unless", NEW))
    )
    package.commit({ROBOT: make_robot(CONTROL.format(plugin=CLASSIC))})
    package.write({ROBOT: make_robot(argument + choice)})
    assert breaking(compare(package)) == []


MANAGER = '<gazebo><plugin filename="{}" name="control"><parameters>c.yaml</parameters></plugin></gazebo>'
GZ_FILE = "gz_ros2_control-system"
LAUNCH = """from launch import LaunchDescription
from launch.actions import ExecuteProcess
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        Node(package="ros_gz_sim", executable="create", arguments=["-topic", "robot_description"]),
        ExecuteProcess(cmd=["ros2", "control", "load_controller", "arm_controller"]),
    ])
"""
LOST = "no controller manager runs in the simulation"


@pytest.mark.parametrize("file", [GZ_FILE, "libgazebo_ros_control.so", "libgazebo_ros2_control.so"])
def test_removed_plugin_of_the_controller_manager_is_breaking(package, compare, file):
    package.commit({ROBOT: make_robot(MANAGER.format(file))})
    package.write({ROBOT: make_robot(f"<!-- {MANAGER.format(file)} -->")})
    assert [str(change.reason) for _, change in compare(package).breaking_changes] == [LOST]


def test_reason_of_a_lost_controller_manager_names_the_launch_file_that_loads_controllers(package, compare):
    path = "arm_description/launch/gazebo.launch.py"
    package.commit({ROBOT: make_robot(MANAGER.format(GZ_FILE)), path: LAUNCH})
    package.write({ROBOT: make_robot("")})
    reasons = [str(change.reason) for _, change in compare(package).breaking_changes]
    assert reasons == [f"{LOST}, where '{path}' loads controllers"]


@pytest.mark.parametrize(
    ("old", "new", "part"),
    [
        (GZ_FILE, "libgazebo_ros2_control.so", ""),
        ("libplotter.so", None, ""),
        (GZ_FILE, None, GZ_FILE),
    ],
    ids=["another-simulator", "another-plugin", "moved-to-another-file"],
)
def test_controller_manager_that_still_runs_breaks_nothing(package, compare, old, new, part):
    package.commit({ROBOT: make_robot(MANAGER.format(old)), PART: make_part("")})
    content = "" if new is None else MANAGER.format(new)
    package.write({ROBOT: make_robot(content), PART: make_part(MANAGER.format(part) if part else "")})
    assert breaking(compare(package)) == []
