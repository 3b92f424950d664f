"""What a configuration package has for Gazebo: hardware, controllers, a fixed base and a launch file."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest

from linkwright import standins
from linkwright.descriptions import examine
from linkwright.graph import ActionClient
from linkwright.launch.frontend.launch_file import load_launch_file
from linkwright.messages import get_action, get_message, get_service
from linkwright.packages import PackageFinder, use_finder
from linkwright.planning.setup.package import package_files
from linkwright.planning.setup.settings import PackageSettings
from linkwright.testing import SteppedSimulation
from tests.planning.arms import urdf
from tests.planning.setup.test_package import settings_of

pytestmark = pytest.mark.extra("arm")

JOINTS = ("pan", "lift", "elbow", "roll", "bend", "twist")
PLUGIN = "<gazebo><plugin name='{name}' filename='{file}'><parameters>{parameters}</parameters></plugin></gazebo>"
OWN_FILE = "/ws/demo_moveit_config/config/ros2_controllers.yaml"
IGNITION = {"name": "ign_ros2_control::IgnitionROS2ControlPlugin", "file": "libvendor_ign_ros2_control-system.so"}
CLASSIC = {"name": "control", "file": "libgazebo_ros2_control.so"}


def control(plugin: str) -> str:
    joints = "".join(f"<joint name='{name}'><command_interface name='position'/></joint>" for name in (*JOINTS, "left"))
    return f"<ros2_control name='own' type='system'><hardware>{plugin}</hardware>{joints}</ros2_control>"


def with_extensions(*texts: str) -> str:
    robot = urdf().replace("<robot ", "<robot xmlns:xacro='http://www.ros.org/wiki/xacro' ")
    return robot.replace("</robot>", "".join(texts) + "</robot>")


def write(settings: PackageSettings, folder: Path) -> Path:
    """Write the files of a package, and return its folder."""
    package = folder / settings.name
    for path, content in package_files(settings).items():
        (package / path).parent.mkdir(parents=True, exist_ok=True)
        (package / path).write_text(content)
    return package


def expand(package: Path, **arguments: str) -> ET.Element:
    """Return the description of a package."""
    finder = PackageFinder(start=[package, package.parent / "demo_description"], environment={})
    description = examine(str(package / "config" / "elbow_arm.urdf.xacro"), arguments=arguments, packages=finder)
    assert description.diagnostics == ()
    return ET.fromstring(description.text)


def hardware_of(robot: ET.Element) -> str | None:
    return robot.findtext("ros2_control/hardware/plugin")


def test_robot_has_gazebos_hardware_and_stands_firmly_only_in_gazebo(tmp_path: Path) -> None:
    package = write(settings_of(tmp_path, urdf()), tmp_path)
    robot = expand(package)
    assert hardware_of(robot) == "mock_components/GenericSystem"
    assert robot.find("gazebo") is None
    assert robot.find("link[@name='world']") is None
    robot = expand(package, ros2_control_hardware_type="gazebo")
    assert hardware_of(robot) == "gz_ros2_control/GazeboSimSystem"
    (plugin,) = robot.iterfind("gazebo/plugin")
    assert plugin.get("name") == "gz_ros2_control::GazeboSimROS2ControlPlugin"
    assert plugin.findtext("parameters") == str(package / "config" / "ros2_controllers.yaml")
    (joint,) = robot.iterfind("joint/child[@link='base']/..")
    assert joint.get("type") == "fixed"
    assert joint.find("parent[@link='world']") is not None


@pytest.mark.parametrize(
    ("plugin", "hardware", "launched"),
    [
        (IGNITION, "ign_ros2_control/IgnitionSystem", "ros_gz_sim"),
        (CLASSIC, "gazebo_ros2_control/GazeboSystem", "gazebo_ros"),
    ],
)
def test_simulator_is_that_of_the_plugin_in_the_description(
    tmp_path: Path, plugin: dict[str, str], hardware: str, launched: str
) -> None:
    settings = settings_of(tmp_path, with_extensions(PLUGIN.format(**plugin, parameters="/other/c.yaml")))
    assert settings.gazebo.controllers_file == "/other/c.yaml"
    settings = settings_of(tmp_path, with_extensions(PLUGIN.format(**plugin, parameters=OWN_FILE)))
    assert settings.gazebo.controllers_file == ""
    package = write(settings, tmp_path)
    robot = expand(package, ros2_control_hardware_type="gazebo")
    assert hardware_of(robot) == hardware
    assert [each.get("filename") for each in robot.iterfind("gazebo/plugin")] == [plugin["file"]]
    assert f'"{launched}"' in (package / "launch" / "demo_gazebo.launch.py").read_text()
    assert f"<exec_depend>{launched}</exec_depend>" in (package / "package.xml").read_text()


def test_hardware_that_gazebo_lacks_is_told_of(tmp_path: Path) -> None:
    for plugin, lacking in (("maker/Robot", ("maker/Robot",)), ("gazebo_ros2_control/GazeboSystem", ())):
        settings = settings_of(tmp_path, with_extensions(control(f"<plugin>{plugin}</plugin>")))
        assert settings.gazebo.other_hardware == lacking
    assert settings.gazebo.simulator.is_classic


def test_links_without_a_mass_are_those_that_move(tmp_path: Path) -> None:
    mass = "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>"
    text = urdf().replace("<link name='tool'/>", f"<link name='tool'>{mass}")
    links = settings_of(tmp_path, text).gazebo.links_without_mass
    assert set(links) == {"shoulder", "upper_arm", "forearm", "wrist", "palm", "left_finger", "right_finger"}


@pytest.mark.parametrize("plugin", [{}, CLASSIC])
def test_launch_file_loads(tmp_path: Path, plugin: dict[str, str]) -> None:
    text = with_extensions(PLUGIN.format(**plugin, parameters=OWN_FILE)) if plugin else urdf()
    package = write(settings_of(tmp_path, text), tmp_path)
    standins.activate()
    with use_finder(PackageFinder(start=[package], environment={})):
        description = load_launch_file(package / "launch" / "demo_gazebo.launch.py")
    assert description.entities


class Controllers:
    """Calls the controller manager of a simulation."""

    def __init__(self, test: SteppedSimulation) -> None:
        self._test = test

    def call(self, kind: str, service: str, **fields: Any) -> None:
        service_type = get_service(f"controller_manager_msgs/srv/{kind}")
        client = self._test.node.create_client(service_type, f"/controller_manager/{service}")
        future = client.call_async(service_type.Request(**fields))
        self._test.advance(0.2)
        assert future.result().ok, service


@pytest.mark.slow
def test_arm_follows_a_trajectory_in_a_simulation(tmp_path: Path) -> None:
    package = write(settings_of(tmp_path, urdf()), tmp_path)
    goal, kinds = (0.5, 0.6, -0.4, 0.3, 0.2, -0.7), get_action("control_msgs/action/FollowJointTrajectory")
    with (
        use_finder(PackageFinder(start=[package], environment={})),
        SteppedSimulation(
            "empty",
            package / "config" / "elbow_arm.urdf.xacro",
            arguments={"ros2_control_hardware_type": "gazebo"},
            robot_state_publisher=True,
        ) as test,
    ):
        test.advance(0.2)
        controllers = Controllers(test)
        controllers.call("LoadController", "load_controller", name="arm_controller")
        controllers.call("ConfigureController", "configure_controller", name="arm_controller")
        controllers.call("SwitchController", "switch_controller", activate_controllers=["arm_controller"], strictness=2)
        point = get_message("trajectory_msgs/msg/JointTrajectoryPoint")(positions=[*goal])
        point.time_from_start.sec = 1
        trajectory = get_message("trajectory_msgs/msg/JointTrajectory")(joint_names=[*JOINTS], points=[point])
        ActionClient(test.node, kinds, "arm_controller/follow_joint_trajectory").send_goal_async(
            kinds.Goal(trajectory=trajectory)
        )
        test.advance(1.5)
        reached = [test.simulation.joint_state(f"elbow_arm::{name}")[0] for name in JOINTS]
        assert reached == pytest.approx(goal, abs=0.002)
