"""Launch files in the styles of public robots: they load, and errors are reported."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest
import yaml
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from nav2_common.launch import (
    HasNodeParams,
    LaunchConfigAsBool,
    ParseMultiRobotPose,
    ReplaceString,
    RewrittenYaml,
)

from launch import LaunchContext
from linkwright.diagnostics import LinkwrightError
from linkwright.launch.arguments import format_arguments
from linkwright.launch.frontend.launch_file import load_launch_file
from linkwright.launch.model.description import LaunchDescription
from linkwright.packages import PackageFinder, use_finder

HEAD = """\
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import IfCondition, UnlessCondition
from launch.event_handlers import OnExecutionComplete, OnProcessExit, OnProcessStart, OnShutdown
from launch.events import Shutdown as ShutdownEvent
from launch.launch_description_sources import PythonLaunchDescriptionSource, AnyLaunchDescriptionSource
from launch.substitutions import *
"""


@pytest.fixture
def robot(write: Any, tmp_path: Path) -> Path:
    """Write a package with a model, parameters and launch files."""
    write("src/bot/package.xml", "<package format='3'><name>bot</name><version>1.0.0</version></package>")
    write("src/bot/urdf/bot.urdf.xacro", '<robot name="bot" xmlns:xacro="x"><link name="base"/></robot>')
    write(
        "src/bot/config/nav.yaml",
        "amcl:\n  ros__parameters:\n    use_sim_time: false\n    alpha: 0.2\n    base: <ns>/base\n"
        "controller:\n  ros__parameters:\n    plugins: [a]\n    a: {speed: 0.1}\n",
    )
    return tmp_path / "src" / "bot"


def check_folder(folder: Path) -> PackageFinder:
    return PackageFinder(start=folder, environment={})


NAVIGATION = (
    HEAD
    + """
from nav2_common.launch import RewrittenYaml

def generate_launch_description():
    bringup = get_package_share_directory('bot')
    namespace = LaunchConfiguration('namespace')
    params = RewrittenYaml(
        source_file=LaunchConfiguration('params_file'), root_key=namespace,
        param_rewrites={'use_sim_time': LaunchConfiguration('use_sim_time')}, convert_types=True)
    ld = LaunchDescription()
    ld.add_action(SetEnvironmentVariable('RCUTILS_LOGGING_BUFFERED_STREAM', '1'))
    ld.add_action(DeclareLaunchArgument('namespace', default_value='robot1', description='Top-level namespace'))
    ld.add_action(DeclareLaunchArgument('use_sim_time', default_value='true', choices=['true', 'false']))
    ld.add_action(DeclareLaunchArgument('params_file', default_value=os.path.join(bringup, 'config', 'nav.yaml')))
    ld.add_action(DeclareLaunchArgument('use_composition', default_value='False'))
    ld.add_action(GroupAction(
        condition=IfCondition(PythonExpression(['not ', LaunchConfiguration('use_composition')])),
        actions=[LogInfo(msg=['params ', params])]))
    return ld
"""
)

MOVEIT = (
    HEAD
    + """
import yaml

def load_yaml(package, path):
    with open(os.path.join(get_package_share_directory(package), path)) as file:
        return yaml.safe_load(file)

def launch_setup(context, *args, **kwargs):
    sim = LaunchConfiguration('sim').perform(context)
    limits = load_yaml('bot', 'config/nav.yaml')
    description = Command([PathJoinSubstitution([FindExecutable(name='xacro')]), ' ',
                           PathJoinSubstitution([get_package_share_directory('bot'), 'urdf', 'bot.urdf.xacro']),
                           ' ', 'sim:=', LaunchConfiguration('sim')])
    return [LogInfo(msg=f"sim {sim} {sorted(limits)}"), LogInfo(msg=description)]

def generate_launch_description():
    declared = []
    declared.append(DeclareLaunchArgument('sim', default_value='false', description='Simulate'))
    return LaunchDescription(declared + [OpaqueFunction(function=launch_setup)])
"""
)

EVENTS = (
    HEAD
    + """
def generate_launch_description():
    first = ExecuteProcess(cmd=['sh', '-c', 'echo one'], output='screen', name='first')
    second = ExecuteProcess(cmd=[['sh', ' -c', ' "echo two"']], shell=True, output='both')
    third = ExecuteProcess(cmd=['sleep', '60'], on_exit=[LogInfo(msg='third ended')])
    return LaunchDescription([
        first,
        RegisterEventHandler(OnProcessStart(target_action=first, on_start=[LogInfo(msg='first started')])),
        RegisterEventHandler(event_handler=OnProcessExit(target_action=first, on_exit=[second, third])),
        RegisterEventHandler(OnProcessExit(target_action=second,
            on_exit=[TimerAction(period=0.1, actions=[EmitEvent(event=ShutdownEvent(reason='all done'))])])),
        RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg=['ended: ', LocalSubstitution('event.reason')])])),
    ])
"""
)

ROBOTS = (
    HEAD
    + """
def generate_launch_description():
    robots = [{'name': 'r1', 'x': 0.0}, {'name': 'r2', 'x': 1.0}]
    groups = []
    for robot in robots:
        groups.append(GroupAction([
            SetLaunchConfiguration('namespace', robot['name']),
            IncludeLaunchDescription(
                AnyLaunchDescriptionSource(os.path.join(os.path.dirname(__file__), 'one.launch.xml')),
                launch_arguments={'x': str(robot['x']), 'name': TextSubstitution(text=robot['name'])}.items()),
        ]))
    return LaunchDescription([*groups, LogInfo(msg=LaunchConfiguration('namespace', default='none left'))])
"""
)

ONE_XML = """
    <launch>
      <arg name="name"/>
      <arg name="x" default="0.0"/>
      <arg name="model" default="$(dirname)/../urdf/bot.urdf.xacro"/>
      <let name="description" value="$(command 'xacro $(var model)')"/>
      <group>
        <log_info message="$(var namespace) $(var name) at $(var x)" if="$(eval '$(var x) &gt; 0.5')"/>
        <log_info message="$(var name) is at home" unless="$(eval '$(var x) &gt; 0.5')"/>
      </group>
    </launch>
"""

SYSTEM_YAML = """
    launch:
    - arg: {name: rviz, default: 'true', description: Show it}
    - group:
        if: $(var rviz)
        children:
        - include:
            file: $(dirname)/one.launch.xml
            arg:
            - {name: name, value: yamlbot}
            - {name: x, value: '0.75'}
        - log_info: {message: '$(env HOME_OF_ROBOT ''nowhere else'')'}
"""


async def test_navigation_launch_file_runs(launch: Any, write: Any, robot: Path) -> None:
    path = write("src/bot/launch/nav.launch.py", NAVIGATION)
    finder = check_folder(robot)
    with use_finder(finder):
        result = await launch(load_launch_file(path), finder=finder)
    assert result.succeeded, result.err
    assert result.messages[0].startswith("params ")


async def test_manipulation_launch_file_runs(launch: Any, write: Any, robot: Path) -> None:
    path = write("src/bot/launch/move_group.launch.py", MOVEIT)
    finder = check_folder(robot)
    with use_finder(finder):
        result = await launch(load_launch_file(path), finder=finder)
    assert result.messages[0] == "sim false ['amcl', 'controller']"
    assert '<link name="base"/>' in result.err


async def test_chained_event_handlers_run(launch: Any, write: Any, robot: Path) -> None:
    result = await launch(load_launch_file(write("src/bot/launch/events.launch.py", EVENTS)))
    assert result.succeeded, result.err
    assert "[first-1] one" in result.out
    assert "two" in result.out
    assert result.messages == ["first started", "ended: all done", "third ended"]


async def test_multi_robot_launch_file_runs(launch: Any, write: Any, robot: Path) -> None:
    write("src/bot/launch/one.launch.xml", dedent(ONE_XML))
    path = write("src/bot/launch/robots.launch.py", ROBOTS)
    result = await launch(load_launch_file(path))
    assert result.messages == ["r1 is at home", "r2 r2 at 1.0", "none left"], result.err


async def test_yaml_file_includes_xml_file(launch: Any, write: Any, robot: Path) -> None:
    write("src/bot/launch/one.launch.xml", dedent(ONE_XML))
    path = write("src/bot/launch/system.launch.yaml", dedent(SYSTEM_YAML))
    description = load_launch_file(path)
    result = await launch(description, namespace="ns", current="x")
    assert "the launch description was not read from a file" in result.err  # $(dirname) needs a launch file
    result = await launch(_launch_file(path), namespace="ns")
    assert result.messages == ["ns yamlbot at 0.75", "nowhere else"], result.err


def _launch_file(path: Path) -> Any:
    from launch.actions import IncludeLaunchDescription

    return IncludeLaunchDescription(path)


LISTING = """\
Arguments (pass arguments as '<name>:=<value>'):

    'rviz':
        Show it
        (default: 'true')"""


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.launch.xml", '<launch><arg name="rviz" default="true" description="Show it"/></launch>'),
        ("a.launch.yaml", "launch:\n- arg: {name: rviz, default: 'true', description: Show it}"),
        (
            "a.launch.py",
            HEAD + "def generate_launch_description():\n    return LaunchDescription([\n"
            "        DeclareLaunchArgument('rviz', default_value='true', description='Show it')])\n",
        ),
    ],
)
def test_show_args_is_the_same_for_all_formats(write: Any, name: str, text: str) -> None:
    assert format_arguments(load_launch_file(write(name, text))) == LISTING


async def test_error_in_nested_include_names_all_files(launch: Any, write: Any) -> None:
    write("c.launch.xml", "<launch>\n  <arg name='x'/>\n  <log_info message='$(var y)'/>\n</launch>")
    write("b.launch.yaml", "launch:\n- include:\n    file: $(dirname)/c.launch.xml\n    arg: [{name: x, value: '1'}]\n")
    path = write(
        "a.launch.py",
        HEAD + "def generate_launch_description():\n    here = os.path.dirname(__file__)\n"
        "    return LaunchDescription([IncludeLaunchDescription(here + '/b.launch.yaml')])\n",
    )
    result = await launch(_launch_file(path))
    assert not result.succeeded
    assert "error[LAUNCH121]: launch configuration 'y' is not set" in result.err
    lines = result.err.splitlines()
    assert any("c.launch.xml:3:" in line for line in lines)
    included = [line for line in lines if "included from here" in line]
    assert len(included) >= 2
    assert "b.launch.yaml:2:3" in result.err
    assert "a.launch.py:12:" in result.err


async def test_missing_include_argument_has_hint(launch: Any, write: Any) -> None:
    write("b.launch.xml", "<launch><arg name='model'/></launch>")
    path = write(
        "a.launch.xml",
        '<launch><include file="$(dirname)/b.launch.xml"><arg name="modle" value="1"/></include></launch>',
    )
    result = await launch(_launch_file(path))
    assert "requires argument 'model', which is not given" in result.err
    assert "did you mean 'model' instead of 'modle'?" in result.err


async def test_missing_package_is_reported(launch: Any, write: Any) -> None:
    text = (
        '<launch><arg name="a" default="1"/><include file="$(find-pkg-share no_such_bot)/launch/a.launch.py"/></launch>'
    )
    path = write("a.launch.xml", text)
    assert "'a':" in format_arguments(load_launch_file(path))
    result = await launch(_launch_file(path))
    assert "no_such_bot" in result.err
    assert not result.succeeded


class TestNavigationSubstitutions:
    @pytest.fixture
    def source(self, write: Any) -> str:
        return str(
            write(
                "nav.yaml",
                "amcl:\n  ros__parameters: {sim: false, base: <ns>/base}\n"
                "ctl:\n  ros__parameters: {list: [{v: 1}], a: {speed: 0.1}, sim: false}\n",
            )
        )

    def test_rewritten_yaml_replaces_parameters(self, source: str) -> None:
        context = LaunchContext()
        context.launch_configurations["sim"] = "True"
        rewritten = RewrittenYaml(
            source_file=source,
            param_rewrites={
                "sim": LaunchConfiguration("sim"),
                "ctl.ros__parameters.a.speed": "0.5",
                "ctl.ros__parameters.list.0.v": "7",
                "new.ros__parameters.deep.x": "text",
                "absent": "1",
            },
            root_key="robot1",
            key_rewrites={"amcl": "loc"},
            value_rewrites={"<ns>/base": "r/base"},
            convert_types=True,
        )
        content = yaml.safe_load(Path(rewritten.perform(context)).read_text())
        assert content == {
            "robot1": {
                "loc": {"ros__parameters": {"sim": True, "base": "r/base"}},
                "ctl": {"ros__parameters": {"list": [{"v": 7}], "a": {"speed": 0.5}, "sim": True}},
                "new": {"ros__parameters": {"deep": {"x": "text"}}},
            }
        }
        rewritten = RewrittenYaml(source, {"v": "7"}).perform(context)
        assert yaml.safe_load(Path(rewritten).read_text())["ctl"]["ros__parameters"]["list"] == [{"v": "7"}]

    def test_rewritten_yaml_of_missing_file_is_rejected(self) -> None:
        with pytest.raises(LinkwrightError) as raised:
            RewrittenYaml("/no/such.yaml", {}).perform(LaunchContext())
        assert raised.value.diagnostics[0].code == "LAUNCH152"

    def test_nav2_substitutions_replace_check_and_convert(self, source: str) -> None:
        context = LaunchContext()
        context.launch_configurations["on"] = "Yes"
        replaced = ReplaceString(source_file=source, replacements={"<ns>": "bot"}).perform(context)
        assert "bot/base" in Path(replaced).read_text()
        unchanged = ReplaceString(source, {"<ns>": "bot"}, condition=IfCondition("false"))
        assert unchanged.perform(context) == source
        assert HasNodeParams(source, "amcl").perform(context) == "True"
        assert HasNodeParams(source, "acml").perform(context) == "False"
        assert LaunchConfigAsBool("on").perform(context) == "True"

    def test_multi_robot_poses_are_parsed(self, monkeypatch: pytest.MonkeyPatch) -> None:
        context = LaunchContext()
        context.launch_configurations["robots"] = "r1={x: 1.0, yaw: 0.5}; r2={y: 2}"
        parsed = ParseMultiRobotPose(LaunchConfiguration("robots")).perform(context)
        assert parsed["r1"] == {"x": 1.0, "y": 0.0, "z": 0.0, "roll": 0.0, "pitch": 0.0, "yaw": 0.5}
        assert parsed["r2"]["y"] == 2
        monkeypatch.setattr("sys.argv", ["ros2", "launch", "robots:=r3={x: 3}"])
        assert list(ParseMultiRobotPose("robots").value()) == ["r3"]


def test_description_can_be_deprecated() -> None:
    description = LaunchDescription(deprecated_reason="use b.launch.py")
    assert description.deprecated
    assert description.deprecated_reason == "use b.launch.py"


async def test_launch_file_with_launch_testing_actions_runs(launch: Any, write: Any) -> None:
    text = (
        HEAD
        + """
import launch_testing.actions
import launch_testing.markers
import launch_testing.util

@launch_testing.markers.keep_alive
def generate_test_description():
    return LaunchDescription([LogInfo(msg='up'), launch_testing.actions.ReadyToTest(),
                              launch_testing.util.KeepAliveProc(),
                              TimerAction(period=0.4, actions=[Shutdown(reason='enough')])]), {}

def generate_launch_description():
    return generate_test_description()[0]
"""
    )
    result = await launch(load_launch_file(write("a.launch.py", text)))
    assert result.messages == ["up"]
    assert result.succeeded
