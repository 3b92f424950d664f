"""Hardware of ros2_control that another simulator than before loads, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import ARM
from tests.review.conftest import breaking, subject

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


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("arm_driver/ArmHardware", NEW, "a simulation is used instead of the hardware of the robot"),
        (NEW, "arm_driver/ArmHardware", "the hardware of the robot is used instead of a simulation"),
        ("arm_driver/SimulatedArm", NEW, None),
        ("topic_based_ros2_control/TopicBasedSystem", NEW, None),
    ],
)
def test_simulation_instead_of_hardware_is_breaking(package, compare, old, new, reason):
    package.commit({PART: make_part(CONTROL.format(plugin=old))})
    package.write({PART: make_part(CONTROL.format(plugin=new))})
    result = compare(package)
    found = [change.reason for found in result.subjects for change in found.changes if change.reason is not None]
    assert [*map(str, found)] == ([reason] if reason else [])


def test_hardware_that_another_changed_file_still_has_is_not_lost(package, compare):
    package.commit({PART: make_part(CONTROL.format(plugin="arm_driver/ArmHardware"))})
    real = "arm_description/urdf/real.xacro"
    package.write({PART: make_part(CONTROL.format(plugin=NEW)), real: make_part("<!-- arm_driver/ArmHardware -->")})
    assert len(breaking(compare(package))) == 1
    package.write({real: make_part(CONTROL.format(plugin="arm_driver/ArmHardware"))})
    assert breaking(compare(package)) == []


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


@pytest.mark.parametrize(("is_kept", "expected"), [(False, [REASON]), (True, [])])
def test_controller_manager_of_another_simulator_is_breaking(package, compare, is_kept, expected):
    old, new = MANAGER.format("libgazebo_ros2_control.so"), MANAGER.format("libgz_ros2_control-system.so")
    package.commit({ROBOT: make_robot(old)})
    argument = '<xacro:arg name="classic" default="false"/>'
    kept = f'<xacro:if value="$(arg classic)">{old}</xacro:if>'
    package.write({ROBOT: make_robot(argument + kept + new if is_kept else new)})
    reasons = [change.reason for found in compare(package).subjects for change in found.changes if change.reason]
    assert [*map(str, reasons)] == expected


SENSOR = '<gazebo reference="upper">{}</gazebo>'
RAY = """<sensor name="scanner" type="ray"><update_rate>10</update_rate>
  <plugin name="scan" filename="libgazebo_ros_ray_sensor.so"><ros><remapping>~/out:=scan</remapping></ros>{}</plugin>
</sensor>"""
LIDAR = '<sensor name="front" type="gpu_lidar"><topic>scan</topic><update_rate>10</update_rate></sensor>'


@pytest.mark.parametrize("frame", ["", "scan_frame"])
def test_lidars_of_both_simulators_are_compared(package, compare, frame):
    package.commit({ROBOT: make_robot(SENSOR.format(RAY.format(frame and f"<frame_name>{frame}</frame_name>")))})
    package.write({ROBOT: make_robot(SENSOR.format(LIDAR))})
    (change,) = [item for item in subject(compare(package), ROBOT).changes if "scanner" in str(item.sentence)]
    assert str(change.sentence).startswith("extension 'gazebo upper': sensor 'scanner' renamed to 'front': ")
    reason = "programs that look for the frame 'scan_frame' in the messages do not find it" if frame else "None"
    assert str(change.reason) == reason


CAMERA = '<sensor name="eye" type="camera"><plugin name="p" filename="libgazebo_ros_camera.so">{}</plugin></sensor>'


@pytest.mark.parametrize(
    ("parameters", "topics"),
    [
        ("<frame_name>upper</frame_name>", "'eye/image_raw', 'eye/camera_info'"),
        ("<ros><remapping>eye/image_raw:=image</remapping></ros>", "'image'"),
        ("<frameName>upper</frameName>", None),
        ("", None),
    ],
)
def test_removed_camera_of_gazebo_classic_has_topics(package, compare, parameters, topics):
    package.commit({ROBOT: make_robot(SENSOR.format(CAMERA.format(parameters)))})
    package.write({ROBOT: make_robot("")})
    reasons = [change.reason for found in compare(package).subjects for change in found.changes if change.reason]
    assert [*map(str, reasons)] == [f"programs that use {topics} do not find the names"] * bool(topics)
