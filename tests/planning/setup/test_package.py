"""The files of a configuration package: its semantic description, its states and its controllers."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import yaml

from linkwright.descriptions import examine
from linkwright.launch.moveit import launches
from linkwright.launch.moveit.builder import MoveItConfigsBuilder
from linkwright.packages import PackageFinder, use_finder
from linkwright.packages.creation.request import Maintainer
from linkwright.planning.collision_scene import CollisionScene
from linkwright.planning.groups import resolve_groups
from linkwright.planning.robot_model import RobotModel
from linkwright.planning.semantics import read_semantics
from linkwright.planning.setup.assistant import PackageChoices, set_up
from linkwright.planning.setup.groups import GroupRequests
from linkwright.planning.setup.package import package_files
from linkwright.planning.setup.settings import PackageSettings
from linkwright.planning.setup.yaml_text import quote_yaml, yaml_number
from linkwright.planning.shapes import robot_shapes
from tests.planning.arms import urdf
from tests.planning.setup.robots import chain, fingers, joint, link, wheels

pytestmark = pytest.mark.extra("arm")

MANIFEST = "<package format='3'><name>{}</name><version>1.0.0</version></package>"


def settings_of(folder: Path, text: str, *, distribution: str = "jazzy", **arguments: str) -> PackageSettings:
    """Return the settings for a description in the package ``demo_description``."""
    path = folder / "demo_description" / "urdf" / "demo.urdf.xacro"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    (folder / "demo_description" / "package.xml").write_text(MANIFEST.format("demo_description"))
    finder = PackageFinder(start=[folder], environment={})
    description = examine(str(path), arguments=arguments, packages=finder)
    assert description.robot is not None
    choices = PackageChoices("demo_moveit_config", Maintainer("A: B", "a@b.c"), "MIT", distribution)
    return set_up(description, description.robot, finder, arguments, GroupRequests(), choices)


@pytest.fixture
def arm_settings(tmp_path: Path) -> PackageSettings:
    return settings_of(tmp_path, urdf())


def test_semantic_description_has_all_parts(arm_settings: PackageSettings) -> None:
    semantics = read_semantics(package_files(arm_settings)["config/elbow_arm.srdf"])
    robot = arm_settings.robot
    assert semantics.name == "elbow_arm"
    assert semantics.groups["arm"].chains == (("base", "tool"),)
    assert semantics.end_effectors[0].parent_group == "arm"
    assert semantics.virtual_joints[0].type == "fixed"
    assert semantics.disabled_collisions[frozenset(("base", "shoulder"))] == "Adjacent"
    groups = resolve_groups(robot, semantics, RobotModel(robot).joint_names)
    assert groups["arm"].joint_names == ("pan", "lift", "elbow", "roll", "bend", "twist")
    assert groups["gripper"].joint_names == ("left",)


def test_states_are_within_limits_and_free_of_collisions(tmp_path: Path) -> None:
    text = urdf().replace("name='elbow' type='revolute'", "name='elbow' type='revolute' ")
    low = "<limit lower='-2.8' upper='2.8' effort='1' velocity='2'/>"
    assert text.count(low) == 6
    text = text.replace(low, "<limit lower='0.1' upper='2.8' effort='1' velocity='2'/>", 2)
    settings = settings_of(tmp_path, text)
    states = settings.states
    assert states["gripper"] == {"open": {"left": 0.03}, "close": {"left": 0.0}}
    assert 0.1 <= states["arm"]["home"]["pan"] <= 2.8
    shapes, _ = robot_shapes(settings.robot, None)  # type: ignore[arg-type]  # it has no meshes
    model = RobotModel(settings.robot)
    positions = np.array([settings.start_positions[name] for name in model.joint_names])
    assert CollisionScene(settings.robot, shapes, (), settings.pairs.allowed()).is_free(positions)


def test_fingers_that_open_inward_are_closed_at_the_other_limit(tmp_path: Path) -> None:
    text = urdf().replace(
        "<axis xyz='0 1 0'/><limit lower='0' upper='0.03'", "<axis xyz='0 -1 0'/><limit lower='0' upper='0.03'"
    )
    text = text.replace(
        "<axis xyz='0 -1 0'/><limit lower='0' upper='0.03' effort='1' velocity='0.1'/><mimic",
        "<axis xyz='0 1 0'/><limit lower='0' upper='0.03' effort='1' velocity='0.1'/><mimic",
    )
    text = text.replace("xyz='0 0.01 0.04'", "xyz='0 0.05 0.04'").replace("xyz='0 -0.01 0.04'", "xyz='0 -0.05 0.04'")
    states = settings_of(tmp_path, text).states
    assert states["gripper"] == {"open": {"left": 0.0}, "close": {"left": 0.03}}


def test_yaml_files_have_the_parameters_of_moveit(arm_settings: PackageSettings) -> None:
    files = {path: text for path, text in package_files(arm_settings).items() if path.endswith(".yaml")}
    parsed = {Path(path).stem: yaml.safe_load(text) for path, text in files.items()}
    manager = parsed["moveit_controllers"]["moveit_simple_controller_manager"]
    assert manager["controller_names"] == ["arm_controller", "gripper_controller"]
    assert manager["gripper_controller"] == {
        "type": "GripperCommand",
        "action_ns": "gripper_cmd",
        "default": True,
        "joints": ["left"],
    }
    assert parsed["ros2_controllers"]["gripper_controller"]["ros__parameters"] == {"joint": "left"}
    assert parsed["kinematics"]["arm"]["kinematics_solver_timeout"] == 0.05
    limit = parsed["joint_limits"]["joint_limits"]["pan"]
    assert limit["max_velocity"] == 2.0
    assert isinstance(limit["max_velocity"], float)
    assert parsed["initial_positions"]["initial_positions"]["left"] == 0.03
    assert parsed["ompl_planning"]["arm"]["planner_configs"][0] == "RRTConnectkConfigDefault"
    assert parsed["pilz_cartesian_limits"]["cartesian_limits"]["max_trans_dec"] == -5.0


@pytest.mark.parametrize(("distribution", "kind"), [("humble", str), ("jazzy", list)])
def test_pipelines_have_the_format_of_the_distribution(tmp_path: Path, distribution: str, kind: type) -> None:
    files = package_files(settings_of(tmp_path, urdf(), distribution=distribution))
    for pipeline in ("ompl", "pilz_industrial_motion_planner"):
        parameters = yaml.safe_load(files[f"config/{pipeline}_planning.yaml"])
        assert isinstance(parameters["request_adapters"], kind)
        assert ("planning_plugins" in parameters) == (distribution == "jazzy")


def test_files_are_the_same_each_time(tmp_path: Path, arm_settings: PackageSettings) -> None:
    assert package_files(settings_of(tmp_path, urdf())) == package_files(arm_settings)


def test_launch_files_load_with_the_builder(tmp_path: Path) -> None:
    text = (
        urdf()
        .replace("<robot ", "<robot xmlns:xacro='http://www.ros.org/wiki/xacro' ")
        .replace(
            "<link name='base'>",
            "<xacro:arg name='kind' default='x'/><link name='$(arg kind)_extra'/>"
            "<joint name='extra' type='fixed'><parent link='base'/><child link='$(arg kind)_extra'/></joint>"
            "<link name='base'>",
        )
    )
    settings = settings_of(tmp_path, text, kind="given")
    folder = tmp_path / settings.name
    for path, content in package_files(settings).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(content)
    with use_finder(PackageFinder(start=[folder], environment={})):
        configs = MoveItConfigsBuilder("elbow_arm", package_name=settings.name).to_moveit_configs()
        parameters: dict[str, Any] = configs.to_dict()
        assert launches.generate_demo_launch(configs).entities
    assert parameters["planning_pipelines"] == ["ompl", "pilz_industrial_motion_planner"]
    urdf_text = parameters["robot_description"]
    assert 'name="given_extra"' in urdf_text
    assert "mock_components/GenericSystem" in urdf_text
    assert '<param name="initial_value">0.03</param>' in urdf_text


@pytest.mark.parametrize(
    ("distribution", "mimic", "parameters"),
    [
        ("jazzy", "multiplier='-2' offset='0.1'", {}),
        ("humble", "multiplier='-2'", {"mimic": "left", "multiplier": "-2.0"}),
        ("humble", "multiplier='-2' offset='0.1'", None),
    ],
)
def test_states_of_a_finger_that_mimics_another_one_are_published(
    tmp_path: Path, distribution: str, mimic: str, parameters: dict[str, str] | None
) -> None:
    text = urdf().replace("<mimic joint='left'/>", f"<mimic joint='left' {mimic}/>")
    files = package_files(settings_of(tmp_path, text, distribution=distribution))
    hardware = ET.fromstring(files["config/elbow_arm.ros2_control.xacro"])
    found = [element for element in hardware.iter("joint") if element.get("name") == "right"]
    if parameters is None:  # Humble's simulated hardware knows no offset.
        assert found == []
        return
    (finger,) = found
    assert [interface.get("name") for interface in finger.iter("state_interface")] == ["position", "velocity"]
    assert finger.find("command_interface") is None
    assert {element.get("name"): element.text for element in finger.findall("param")} == parameters


def test_mobile_robot_has_planar_joint_and_passive_wheels(tmp_path: Path) -> None:
    text = "".join((link("base", 0.2), wheels("base"), chain("base", "", 4), fingers("link_4", "", 3, mimic=False)))
    files = package_files(settings_of(tmp_path, f"<robot name='my robot'>{text}</robot>"))
    semantics = read_semantics(files["config/my_robot.srdf"])
    assert semantics.virtual_joints[0].type == "planar"
    assert "left_wheel_joint" in semantics.passive_joints
    controllers = yaml.safe_load(files["config/ros2_controllers.yaml"])
    assert controllers["gripper_controller"]["ros__parameters"]["joints"] == [
        "finger_1_joint",
        "finger_2_joint",
        "finger_3_joint",
    ]
    assert "left_wheel" not in files["config/my_robot.ros2_control.xacro"]


def test_joints_with_hardware_keep_it(tmp_path: Path) -> None:
    control = "<ros2_control name='own' type='system'><hardware><plugin>p/P</plugin></hardware>{}</ros2_control>"
    names = ("pan", "lift", "elbow", "roll", "bend", "twist")
    joints = "".join(f"<joint name='{name}'><command_interface name='position'/></joint>" for name in names)
    settings = settings_of(tmp_path, urdf().replace("</robot>", control.format(joints) + "</robot>"))
    assert settings.simulated_joints == ("left",)
    everything = joints + "<joint name='left'><command_interface name='position'/></joint>"
    settings = settings_of(tmp_path, urdf().replace("</robot>", control.format(everything) + "</robot>"))
    files = package_files(settings)
    assert "config/elbow_arm.ros2_control.xacro" not in files
    assert "elbow_arm_ros2_control" not in files["config/elbow_arm.urdf.xacro"]


def test_description_without_package_is_copied(tmp_path: Path) -> None:
    settings = settings_of(tmp_path, urdf())
    (tmp_path / "demo_description" / "package.xml").unlink()
    settings = settings_of_file(tmp_path / "demo_description" / "urdf" / "demo.urdf.xacro")
    files = package_files(settings)
    assert files["config/elbow_arm.urdf"].startswith("<")
    assert '<xacro:include filename="elbow_arm.urdf"/>' in files["config/elbow_arm.urdf.xacro"]
    assert yaml.safe_load(files[".setup_assistant"])["moveit_setup_assistant_config"]["urdf"] == {
        "package": "demo_moveit_config",
        "relative_path": "config/elbow_arm.urdf",
    }


def settings_of_file(path: Path) -> PackageSettings:
    finder = PackageFinder(start=[path.parent], environment={})
    description = examine(str(path), packages=finder)
    assert description.robot is not None
    choices = PackageChoices("demo_moveit_config", Maintainer("A", "a@b.c"), "MIT", "jazzy")
    return set_up(description, description.robot, finder, {}, GroupRequests(), choices)


@pytest.mark.parametrize("text", ["plain", "yes", "1.0", "a: b", "joint-1", "", "#x", "名"])
def test_yaml_texts_are_read_as_they_were(text: str) -> None:
    assert yaml.safe_load(quote_yaml(text)) == text


@pytest.mark.parametrize("value", [0.0, 2.0, 1e-5, -3.14159, 12345.5])
def test_yaml_numbers_are_floats(value: float) -> None:
    read = yaml.safe_load(yaml_number(value))
    assert isinstance(read, float)
    assert read == pytest.approx(value)


def test_continuous_gripper_has_no_states_to_choose(tmp_path: Path) -> None:
    text = chain("base", "", 5) + link("jaw", 0.02) + joint("gripper_joint", "link_5", "jaw", kind="continuous")
    settings = settings_of(tmp_path, f"<robot name='arm'>{link('base', 0.1)}{text}</robot>")
    assert settings.states["gripper"] == {"open": {"gripper_joint": 0.0}, "close": {"gripper_joint": 0.0}}
