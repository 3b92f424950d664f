"""Launch files of MoveIt configuration packages."""

from __future__ import annotations

import sys
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest
from launch.substitutions import LaunchConfiguration
from launch_param_builder import ParameterBuilder, get_path, load_file, load_xacro, load_yaml
from launch_ros.actions import Node
from moveit_configs_utils import MoveItConfigsBuilder, launches
from moveit_configs_utils.substitutions import Xacro

from launch import LaunchContext
from linkwright.diagnostics import LinkwrightError, package_hint
from linkwright.launch.frontend.launch_file import load_launch_file
from linkwright.packages import PackageFinder, use_finder

SRDF = '<robot name="arm"><virtual_joint name="v" type="fixed" parent_frame="world" child_link="base"/></robot>'
URDF = """\
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="tool" default="none"/>
  <link name="base"/>
  <link name="tool_$(arg tool)"/>
  <joint name="j" type="fixed"><parent link="base"/><child link="tool_$(arg tool)"/></joint>
</robot>
"""


@pytest.fixture
def arm(write: Any, tmp_path: Path) -> Any:
    """Create a configuration package in the form of the Setup Assistant."""
    folder = "src/arm_moveit_config"
    for name in ("arm_moveit_config", "arm_description"):
        write(f"src/{name}/package.xml", f"<package format='3'><name>{name}</name><version>1.0.0</version></package>")
    write("src/arm_description/urdf/arm.urdf.xacro", URDF)
    settings = (
        "moveit_setup_assistant_config:\n  urdf: {package: arm_description, relative_path: urdf/arm.urdf.xacro}\n"
    )
    write(f"{folder}/.setup_assistant", settings + "  srdf: {relative_path: config/arm.srdf}\n")
    write(f"{folder}/config/arm.srdf", SRDF)
    write(f"{folder}/config/kinematics.yaml", "arm: {kinematics_solver: kdl}\n")
    write(f"{folder}/config/joint_limits.yaml", "joint_limits: {j: {max_velocity: 1.0}}\n")
    write(f"{folder}/config/pilz_cartesian_limits.yaml", "cartesian_limits: {max_trans_vel: 1.0}\n")
    controllers = "moveit_simple_controller_manager: {controller_names: [arm_controller]}\n"
    write(f"{folder}/config/moveit_controllers.yaml", controllers)
    write(f"{folder}/config/ros2_controllers.yaml", "controller_manager: {}\n")
    write(f"{folder}/config/ompl_planning.yaml", "planning_plugins: [ompl]\n")
    with use_finder(PackageFinder(start=tmp_path / "src" / "arm_moveit_config", environment={})) as finder:
        yield finder


@pytest.mark.usefixtures("arm")
class TestBuilder:
    def test_default_files_are_loaded(self, tmp_path: Path) -> None:
        configs = MoveItConfigsBuilder("arm").to_moveit_configs()
        assert configs.package_path == tmp_path / "src" / "arm_moveit_config"
        assert '<link name="tool_none"/>' in configs.robot_description["robot_description"]
        assert 'name="v"' in configs.robot_description_semantic["robot_description_semantic"]
        parameters = configs.to_dict()
        assert parameters["robot_description_kinematics"] == {"arm": {"kinematics_solver": "kdl"}}
        assert parameters["robot_description_planning"] == {
            "joint_limits": {"j": {"max_velocity": 1.0}},
            "cartesian_limits": {"max_trans_vel": 1.0},
        }
        assert parameters["planning_pipelines"] == ["ompl"]
        assert parameters["default_planning_pipeline"] == "ompl"
        assert parameters["ompl"] == {"planning_plugins": ["ompl"]}
        assert parameters["moveit_manage_controllers"] is True
        assert parameters["publish_robot_description"] is False

    def test_xacro_arguments_of_setup_assistant_are_used(self, write: Any) -> None:
        urdf = "{package: arm_description, relative_path: urdf/arm.urdf.xacro, xacro_args: 'tool:=noted  odd'}"
        write("src/arm_moveit_config/.setup_assistant", f"moveit_setup_assistant_config:\n  urdf: {urdf}\n")
        noted = MoveItConfigsBuilder("arm").to_moveit_configs().robot_description["robot_description"]
        assert '<link name="tool_noted"/>' in noted
        configs = MoveItConfigsBuilder("arm").robot_description(mappings={"tool": "given"}).to_moveit_configs()
        assert '<link name="tool_given"/>' in configs.robot_description["robot_description"]

    def test_setup_assistant_arguments_apply_to_configuration_model(self, write: Any) -> None:
        write("src/arm_moveit_config/config/arm.urdf.xacro", URDF)
        urdf = "{package: arm_description, relative_path: urdf/arm.urdf.xacro, xacro_args: 'tool:=noted'}"
        write("src/arm_moveit_config/.setup_assistant", f"moveit_setup_assistant_config:\n  urdf: {urdf}\n")
        noted = MoveItConfigsBuilder("arm").to_moveit_configs().robot_description["robot_description"]
        assert '<link name="tool_noted"/>' in noted

    def test_missing_model_is_reported_and_rest_is_loaded(
        self, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        (tmp_path / "src/arm_description/urdf/arm.urdf.xacro").unlink()
        configs = MoveItConfigsBuilder("arm").to_moveit_configs()
        assert configs.robot_description == {}
        assert 'name="v"' in configs.robot_description_semantic["robot_description_semantic"]
        warning = capsys.readouterr().err
        assert "warning[LAUNCH153]: parameter file " in warning
        assert "read it from the topic /robot_description" in warning

    def test_builder_options_override_defaults(self) -> None:
        configs = (
            MoveItConfigsBuilder("arm", robot_description="model", package_name="arm_moveit_config")
            .robot_description(mappings={"tool": "hook"})
            .robot_description_semantic(file_path="config/arm.srdf")
            .trajectory_execution(file_path="config/ros2_controllers.yaml", moveit_manage_controllers=False)
            .planning_scene_monitor(publish_robot_description=True)
            .planning_pipelines(pipelines=["ompl", "chomp"], default_planning_pipeline="chomp")
            .to_moveit_configs()
        )
        assert "tool_hook" in configs.robot_description["model"]
        assert configs.trajectory_execution == {"moveit_manage_controllers": False, "controller_manager": {}}
        assert configs.planning_pipelines["default_planning_pipeline"] == "chomp"
        assert configs.planning_pipelines["chomp"] == {}
        assert configs.planning_scene_monitor["publish_robot_description"]

    def test_builders_do_not_share_state(self) -> None:
        MoveItConfigsBuilder("arm").robot_description(mappings={"tool": "hook"})
        second = MoveItConfigsBuilder("arm").to_moveit_configs()
        assert "tool_none" in second.robot_description["robot_description"]

    def test_xacro_mappings_can_be_substitutions(self) -> None:
        builder = MoveItConfigsBuilder("arm").robot_description(mappings={"tool": LaunchConfiguration("tool")})
        value = builder.to_moveit_configs().robot_description["robot_description"]
        context = LaunchContext()
        context.launch_configurations["tool"] = "saw"
        assert "tool_saw" in value.evaluate(context)

    def test_ambiguous_controllers_file_is_rejected(self, write: Any) -> None:
        folder = "src/arm_moveit_config/config"
        (Path(write(f"{folder}/left_controllers.yaml", "a: 1\n")).parent / "moveit_controllers.yaml").unlink()
        with pytest.raises(RuntimeError, match="Unable to guess") as caught:
            MoveItConfigsBuilder("arm").trajectory_execution()
        assert caught.value.diagnostics[0].code == "LAUNCH154"  # type: ignore[attr-defined]

    def test_unknown_default_pipeline_is_rejected(self) -> None:
        with pytest.raises(RuntimeError, match="doesn't name any of the input pipelines"):
            MoveItConfigsBuilder("arm").planning_pipelines("stomp", ["ompl"])

    def test_missing_package_is_rejected(self) -> None:
        with pytest.raises(LinkwrightError, match="leg_moveit_config"):
            MoveItConfigsBuilder("leg")

    def test_missing_file_is_rejected_with_hint(self) -> None:
        with pytest.raises(KeyError) as caught:
            MoveItConfigsBuilder("arm").joint_limits("config/limits.yaml")
        (diagnostic,) = caught.value.diagnostics  # type: ignore[attr-defined]
        assert diagnostic.code == "LAUNCH153"
        assert diagnostic.hint is not None


@pytest.mark.usefixtures("arm")
class TestParameters:
    def test_parameter_builder_merges_parameters(self, write: Any) -> None:
        write("src/arm_moveit_config/config/notes.txt", "some text")
        parameters = (
            ParameterBuilder("arm_moveit_config")
            .yaml("config/kinematics.yaml")
            .yaml("config/joint_limits.yaml", parameter_namespace="limits")
            .yaml("config/kinematics.yaml", parameter_namespace="limits")
            .file_parameter("notes", "config/notes.txt")
            .xacro_parameter("semantic", "config/arm.srdf")
            .parameter("rate", 10.0)
            .to_dict()
        )
        assert set(parameters) == {"arm", "limits", "notes", "semantic", "rate"}
        assert set(parameters["limits"]) == {"joint_limits", "arm"}
        assert parameters["notes"] == "some text"

    def test_load_functions_read_files(self, write: Any, tmp_path: Path) -> None:
        assert load_yaml(get_path("arm_moveit_config", "config/kinematics.yaml")) == {
            "arm": {"kinematics_solver": "kdl"}
        }
        assert "virtual_joint" in load_file(tmp_path / "src/arm_moveit_config/config/arm.srdf")
        assert "virtual_joint" in load_xacro(tmp_path / "src/arm_moveit_config/config/arm.srdf")
        for name, text in (("bad.yaml", "a: [1"), ("template.yaml", "a: {{ radians(180 }}")):
            with pytest.raises(LinkwrightError) as caught:
                load_yaml(write(name, text))
            assert caught.value.diagnostics[0].code == "LAUNCH153"
        with pytest.raises(LinkwrightError, match="cannot be read"):
            load_file(tmp_path)

    def test_yaml_templates_are_rendered(self, write: Any) -> None:
        pytest.importorskip("jinja2")
        path = write("limits.yaml", "angle: {{ radians(180) | round(2) }}\nname: {{ who }}\n")
        assert load_yaml(path, mappings={"who": "arm"}) == {"angle": 3.14, "name": "arm"}

    def test_yaml_templates_without_jinja2_have_install_hint(self, write: Any, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setitem(sys.modules, "jinja2", None)
        with pytest.raises(LinkwrightError) as caught:
            load_yaml(write("limits.yaml", "angle: {{ radians(180) }}\n"))
        assert caught.value.diagnostics[0].hint == package_hint("jinja2")

    def test_xacro_substitution_expands_model(self, tmp_path: Path) -> None:
        path = str(tmp_path / "src/arm_description/urdf/arm.urdf.xacro")
        model = Xacro([path], mappings={"tool": [LaunchConfiguration("tool"), "s"]})
        context = LaunchContext()
        context.launch_configurations["tool"] = "fork"
        assert "tool_forks" in model.perform(context)
        assert path in model.describe()
        with pytest.raises(LinkwrightError, match="does not exist"):
            Xacro("/nowhere.xacro").perform(context)


@pytest.mark.usefixtures("arm")
class TestLaunches:
    NAMES = (
        "rsp",
        "moveit_rviz",
        "setup_assistant",
        "static_virtual_joint_tfs",
        "spawn_controllers",
        "warehouse_db",
        "move_group",
        "demo",
    )

    def files(self, write: Any) -> dict[str, Path]:
        text = """\
        from moveit_configs_utils import MoveItConfigsBuilder
        from moveit_configs_utils.launches import generate_{0}_launch

        def generate_launch_description():
            configs = MoveItConfigsBuilder("arm", package_name="arm_moveit_config").to_moveit_configs()
            return generate_{0}_launch(configs)
        """
        folder = "src/arm_moveit_config/launch"
        return {name: write(f"{folder}/{name}.launch.py", dedent(text).format(name)) for name in self.NAMES}

    def test_launch_files_load(self, write: Any) -> None:
        for path in self.files(write).values():
            load_launch_file(path)

    def test_demo_launch_file_declares_arguments(self, write: Any) -> None:
        files = self.files(write)
        names = {argument.name for argument in load_launch_file(files["demo"]).get_launch_arguments()}
        assert {"db", "debug", "use_rviz", "publish_frequency", "rviz_config", "capabilities"} <= names

    def test_spawner_and_virtual_joint_launches_start_nodes(self, write: Any) -> None:
        configs = MoveItConfigsBuilder("arm").to_moveit_configs()
        spawned = launches.generate_spawn_controllers_launch(configs).entities
        context = LaunchContext()
        assert [node.cmd[1][0].perform(context) for node in spawned if isinstance(node, Node)] == [
            "arm_controller",
            "joint_state_broadcaster",
        ]
        (transform,) = launches.generate_static_virtual_joint_tfs_launch(configs).entities
        assert [word[0].perform(context) for word in transform.cmd[1:5]] == [
            "--frame-id",
            "world",
            "--child-frame-id",
            "base",
        ]

    async def test_rsp_launch_file_publishes_robot(self, write: Any, launch: Any, arm: PackageFinder) -> None:
        from launch.actions import EmitEvent, TimerAction
        from launch.events import Shutdown

        description = load_launch_file(self.files(write)["rsp"])
        ending = TimerAction(period=0.3, actions=[EmitEvent(event=Shutdown(reason="seen"))])
        result = await launch(description, ending, finder=arm)
        assert result.succeeded, result.err
        assert "robot_state_publisher-1" in result.err
