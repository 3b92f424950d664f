"""The values of a description's arguments in a workspace."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.descriptions.argument_sets import ArgumentSet, argument_sets

ROBOT = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r"><link name="$(arg prefix)base"/></robot>'
MANIFEST = "<package format='3'><name>{name}</name><exec_depend>{needs}</exec_depend></package>"


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """Create a workspace with the packages ``arm`` and ``user``.

    The robot of ``arm`` has arguments, and ``user`` depends on ``arm``.
    """
    for name, needs in (("arm", "xacro"), ("user", "arm")):
        folder = tmp_path / "src" / name
        folder.mkdir(parents=True)
        (folder / "package.xml").write_text(MANIFEST.format(name=name, needs=needs))
    robot = tmp_path / "src/arm/urdf/arm.urdf.xacro"
    robot.parent.mkdir()
    robot.write_text(ROBOT)
    return tmp_path / "src"


def find_argument_sets(workspace: Path, file: str, text: str) -> list[ArgumentSet]:
    """Return the sets of values that one file passes to the robot of the workspace."""
    path = workspace / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return list(argument_sets(workspace / "arm/urdf/arm.urdf.xacro"))


def certain_values(argument_sets: list[ArgumentSet]) -> list[dict[str, str]]:
    """Return the values of the sets that are certain to occur."""
    return [dict(argument_set.values) for argument_set in argument_sets if argument_set.is_complete]


HEAD = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import Command, FindExecutable, LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare
"""
COMMAND = """
    Command([
        PathJoinSubstitution([FindExecutable(name='xacro')]), ' ',
        PathJoinSubstitution([FindPackageShare('arm'), 'urdf', 'arm.urdf.xacro']),
        ' ', 'name:=robot', ' prefix:=', LaunchConfiguration('prefix'),
    ])
"""


def launch_file_text(of_argument: str = "") -> str:
    """Write a launch file that passes its argument ``prefix`` to the robot."""
    declared = f"DeclareLaunchArgument('prefix', {of_argument})"
    return f"{HEAD}\ndef generate_launch_description():\n    {declared}\n{COMMAND}"


def test_command_uses_default_of_launch_argument(workspace: Path) -> None:
    text = launch_file_text("default_value='a_'")
    assert certain_values(find_argument_sets(workspace, "arm/launch/view.launch.py", text)) == [
        {"name": "robot", "prefix": "a_"}
    ]


def test_each_choice_of_launch_argument_is_a_set(workspace: Path) -> None:
    text = launch_file_text("choices=['a_', 'b_']")
    argument_sets = find_argument_sets(workspace, "arm/launch/view.launch.py", text)
    assert [value["prefix"] for value in certain_values(argument_sets)] == ["a_", "b_"]
    assert argument_sets[1].varied == ("prefix",)
    assert argument_sets[0].span is not None
    assert argument_sets[0].span.file.endswith("view.launch.py")


def test_launch_argument_without_values_stays_open(workspace: Path) -> None:
    text = launch_file_text()
    (argument_set,) = find_argument_sets(workspace, "arm/launch/view.launch.py", text)
    assert argument_set.runtime_names == ("prefix",)
    assert not argument_set.is_complete


def test_dependent_package_provides_values(workspace: Path) -> None:
    text = launch_file_text("default_value='u_'")
    assert certain_values(find_argument_sets(workspace, "user/launch/user.launch.py", text)) == [
        {"name": "robot", "prefix": "u_"}
    ]


def test_including_launch_file_provides_arguments(workspace: Path) -> None:
    included = launch_file_text("default_value='a_'")
    (workspace / "arm/launch").mkdir()
    (workspace / "arm/launch/inner.launch.py").write_text(included)
    including = f"""{HEAD}
def generate_launch_description():
    return LaunchDescription([IncludeLaunchDescription(
        PathJoinSubstitution([FindPackageShare('arm'), 'launch', 'inner.launch.py']),
        launch_arguments={{'prefix': 'outer_'}}.items(),
    )])
"""
    prefixes = certain_values(find_argument_sets(workspace, "user/launch/outer.launch.py", including))
    assert [arguments["prefix"] for arguments in prefixes] == ["a_", "outer_"]


def test_parametrized_test_with_process_file_provides_values(workspace: Path) -> None:
    text = """
import os, pytest, xacro
from ament_index_python.packages import get_package_share_directory

@pytest.mark.parametrize('prefix', ['a_', 'b_'])
@pytest.mark.parametrize('sim, gripper', [('true', 'none'), ('false', 'big')])
def test_expands(prefix, sim, gripper):
    path = os.path.join(get_package_share_directory('arm'), 'urdf', 'arm.urdf.xacro')
    xacro.process_file(path, mappings={'prefix': prefix, 'sim': sim, 'gripper': gripper})
"""
    assert certain_values(find_argument_sets(workspace, "arm/test/test_arm.py", text)) == [
        {"prefix": "a_", "sim": "true", "gripper": "none"},
        {"prefix": "b_", "sim": "true", "gripper": "none"},
        {"prefix": "a_", "sim": "false", "gripper": "big"},
    ]


def test_loop_over_combinations_provides_values(workspace: Path) -> None:
    text = """
import itertools, xacro
from ament_index_python.packages import get_package_share_path

def test_expands():
    prefixes = ['a_', 'b_']
    for combination in list(itertools.product(prefixes, ['1', '2'])):
        prefix, dof = combination
        path = get_package_share_path('arm') / 'urdf' / 'arm.urdf.xacro'
        xacro.process_file(path, mappings=dict(prefix=prefix, dof=dof))
"""
    argument_values = certain_values(find_argument_sets(workspace, "arm/test/test_arm.py", text))
    assert argument_values == [{"prefix": "a_", "dof": "1"}, {"prefix": "b_", "dof": "1"}, {"prefix": "a_", "dof": "2"}]


def test_shell_command_in_f_string_provides_values(workspace: Path) -> None:
    text = """
import os, shutil, subprocess
from ament_index_python.packages import get_package_share_directory

def test_expands():
    path = os.path.join(get_package_share_directory("arm"), "urdf", "arm.urdf.xacro")
    command = (f"{shutil.which('xacro')}" f" {path}" f" prefix:=a_" f" > /tmp/out.urdf")
    subprocess.run(command, shell=True)
"""
    assert certain_values(find_argument_sets(workspace, "arm/test/test_arm.py", text)) == [{"prefix": "a_"}]


def test_values_chosen_by_conditions_are_not_combined(workspace: Path) -> None:
    text = """
import os, xacro
from ament_index_python.packages import get_package_share_directory

def generate_launch_description():
    one = 'false'
    if input('which? ') == '1':
        one = 'true'
    doc = xacro.parse(open(os.path.join(get_package_share_directory('arm'), 'urdf/arm.urdf.xacro')))
    xacro.process_doc(doc, mappings={'one': one})
"""
    argument_sets = find_argument_sets(workspace, "arm/launch/view.launch.py", text)
    assert [dict(argument_set.values) for argument_set in argument_sets] == [{"one": "false"}, {"one": "true"}]
    assert not any(argument_set.is_complete for argument_set in argument_sets)


def test_moveit_configs_builder_provides_values(workspace: Path) -> None:
    text = """
from moveit_configs_utils import MoveItConfigsBuilder

def generate_launch_description():
    config = (
        MoveItConfigsBuilder('arm', package_name='arm')
        .robot_description(file_path='urdf/arm.urdf.xacro', mappings={'prefix': 'm_'})
        .to_moveit_configs()
    )
"""
    assert certain_values(find_argument_sets(workspace, "user/launch/move.launch.py", text)) == [{"prefix": "m_"}]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (
            "view.launch.xml",
            """<launch><arg name="prefix" default="x_"/><node pkg="p" exec="e"><param name="d"
            value="$(command 'xacro $(find-pkg-share arm)/urdf/arm.urdf.xacro prefix:=$(var prefix)')"/>
            </node></launch>""",
        ),
        (
            "quoted.launch.xml",
            """<launch><arg name="prefix" default="x_"/>
            <let name="file" value="'$(find-pkg-share arm)/urdf/arm.urdf.xacro'"/><node pkg="p" exec="e">
            <param name="d" value="$(command 'xacro $(var file) prefix:=$(var prefix)')"/></node></launch>""",
        ),
        (
            "view.launch",
            """<launch><arg name="prefix" default="x_"/><param name="robot_description"
            command="$(find xacro)/xacro --inorder '$(find arm)/urdf/arm.urdf.xacro' prefix:=$(arg prefix)"/>
            </launch>""",
        ),
        (
            "optional.launch",
            """<launch><arg name="long" value="prefix:='x_'"/><param name="robot_description"
            command="$(find xacro)/xacro $(find arm)/urdf/arm.urdf.xacro $(arg long)"/></launch>""",
        ),
        (
            "view.launch.yaml",
            """
launch:
  - arg: {name: prefix, default: x_}
  - node:
      pkg: p
      exec: e
      param:
        - name: robot_description
          value: "$(command 'xacro $(find-pkg-share arm)/urdf/arm.urdf.xacro prefix:=$(var prefix)')"
""",
        ),
    ],
)
def test_xml_and_yaml_launch_files_provide_values(workspace: Path, name: str, text: str) -> None:
    assert certain_values(find_argument_sets(workspace, f"arm/launch/{name}", text)) == [{"prefix": "x_"}]


@pytest.mark.parametrize(
    ("default", "environment", "is_open"),
    [("$(optenv EXTRAS)", {}, ("prefix",)), ("$(optenv EXTRAS none.urdf)", {"prefix": "none.urdf"}, ())],
)
def test_environment_variable_uses_written_default(
    workspace: Path, default: str, environment: dict[str, str], is_open: tuple[str, ...]
) -> None:
    text = f"""<launch><arg name="prefix" default="{default}"/><param name="robot_description"
        command="$(find xacro)/xacro '$(find arm)/urdf/arm.urdf.xacro' prefix:=$(arg prefix)"/></launch>"""
    (argument_set,) = find_argument_sets(workspace, "arm/launch/view.launch", text)
    assert (argument_set.values, argument_set.runtime_names) == (environment, is_open)


def test_share_folder_inside_path_is_uncertain(workspace: Path) -> None:
    text = """<launch><let name="file" value="./$(find-pkg-share arm)/urdf/arm.urdf.xacro"/><node pkg="p" exec="e">
        <param name="d" value="$(command 'xacro $(var file) prefix:=x_')"/></node></launch>"""
    assert [
        argument_set.is_certain for argument_set in find_argument_sets(workspace, "arm/launch/view.launch.xml", text)
    ] == [False]


@pytest.mark.parametrize(
    "text",
    [
        "xacro_add_xacro_file(urdf/arm.urdf.xacro REMAP prefix:=c_)",
        "add_custom_target(a COMMAND xacro ${CMAKE_CURRENT_SOURCE_DIR}/urdf/arm.urdf.xacro prefix:=c_)",
    ],
)
def test_cmake_files_provide_values(workspace: Path, text: str) -> None:
    assert certain_values(find_argument_sets(workspace, "arm/CMakeLists.txt", f"project(arm)\n{text}\n")) == [
        {"prefix": "c_"}
    ]


JOINED = """
    DeclareLaunchArgument('file', default_value={default})
    Command([
        'xacro ', PathJoinSubstitution([FindPackageShare('arm'), 'urdf', 'arm.urdf.xacro']),
        ' prefix:=', PathJoinSubstitution([FindPackageShare('user'), 'config', LaunchConfiguration('file')]),
    ])
"""


@pytest.mark.parametrize(
    ("default", "expected"),
    [
        ("'a.yaml'", "{user}/config/a.yaml"),
        ("'/etc/a.yaml'", "/etc/a.yaml"),
        ("PathJoinSubstitution([FindPackageShare('arm'), 'config', 'a.yaml'])", "{arm}/config/a.yaml"),
    ],
)
def test_absolute_path_component_restarts_joined_path(workspace: Path, default: str, expected: str) -> None:
    text = f"{HEAD}\ndef generate_launch_description():\n{JOINED.format(default=default)}"
    expected_text = expected.format(user=workspace / "user", arm=workspace / "arm")
    assert certain_values(find_argument_sets(workspace, "user/launch/a.launch.py", text)) == [{"prefix": expected_text}]


ROBOT_FILE = "PathJoinSubstitution([FindPackageShare('arm'), 'urdf', 'arm.urdf.xacro'])"


@pytest.mark.parametrize(
    "text",
    [
        f"""
def content(arguments={{}}):
    command = ['xacro ', {ROBOT_FILE}, ' ']
    for key, value in arguments.items():
        command.extend([f'{{key}}:=', value, ' '])
    return Command(command)
""",
        f"""
def content(words):
    command = ['xacro ', {ROBOT_FILE}, ' ']
    for word in words:
        command.append(word)
    return Command(command)
""",
        f"""
def content(urdf_arguments={{}}):
    urdf_arguments['plugin'] = 'p'
    return expanded({ROBOT_FILE}, urdf_arguments)
""",
        f"def content(given):\n    return expanded({ROBOT_FILE}, {{'plugin': 'p', **given}})",
        f"def content(given):\n    return expanded({ROBOT_FILE}, {{'plugin': 'p'}} | given)",
        f"def content(name):\n    return expanded({ROBOT_FILE}, {{name: 'p'}})",
        f"def content(given):\n    all = {{}}\n    all.update(given)\n    return expanded({ROBOT_FILE}, all)",
        f"def content(given):\n    return xacro.process_file({ROBOT_FILE}, mappings=given)",
    ],
    ids=["extend", "append", "default", "stars", "or", "key", "update", "process_file"],
)
def test_helper_without_known_callers_is_incomplete(workspace: Path, text: str) -> None:
    (argument_set,) = find_argument_sets(workspace, "user/launch/helper.py", HEAD + text)
    assert "" in argument_set.runtime_names
    assert not argument_set.is_complete


@pytest.mark.parametrize(
    "text",
    [
        f"command = ['xacro ', {ROBOT_FILE}, ' ']\ncommand.extend(['prefix:=', 'a_'])\nCommand(command)",
        f"command = ['xacro ', {ROBOT_FILE}]\ncommand.append(' prefix:=a_')\nCommand(command)",
        f"given = {{}}\ngiven.update({{'prefix': 'a_'}})\nexpanded({ROBOT_FILE}, given)",
        f"words = LaunchConfiguration('words', default='prefix:=a_')\nCommand(['xacro ', {ROBOT_FILE}, ' ', words])",
    ],
    ids=["extend", "append", "update", "words"],
)
def test_values_added_later_to_list_or_mapping_are_used(workspace: Path, text: str) -> None:
    assert certain_values(find_argument_sets(workspace, "user/launch/later.launch.py", HEAD + text)) == [
        {"prefix": "a_"}
    ]


def test_call_without_arguments_is_an_empty_set(workspace: Path) -> None:
    text = """
import xacro
from ament_index_python.packages import get_package_share_path

def test_expands():
    xacro.process_file(get_package_share_path('arm') / 'urdf/arm.urdf.xacro')
"""
    assert certain_values(find_argument_sets(workspace, "arm/test/test_arm.py", text)) == [{}]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("arm/launch/a.launch.py", "def generate_launch_description(:"),
        ("arm/launch/a.launch.xml", "<launch><include"),
        ("arm/launch/a.launch.yaml", "launch: [include: {file: [1], arg: 3}, {arg: null}, 3, {xacro: [[]]}]"),
        (
            "arm/launch/b.launch.py",
            "Command(Command)\nCommand(['xacro', *x, **y])\n'xacro '.format(1)\nIncludeLaunchDescription()",
        ),
        ("arm/CMakeLists.txt", "xacro_add_xacro_file()\nadd_custom_command(COMMAND xacro)"),
    ],
)
def test_malformed_files_provide_no_values(workspace: Path, name: str, text: str) -> None:
    assert find_argument_sets(workspace, name, text) == []


def test_other_file_of_same_name_is_ignored(workspace: Path) -> None:
    text = """
import xacro
from ament_index_python.packages import get_package_share_path

def test_expands():
    xacro.process_file(get_package_share_path('user') / 'urdf/arm.urdf.xacro', mappings={'prefix': 'no_'})
"""
    assert find_argument_sets(workspace, "user/test/test_user.py", text) == []


def test_xml_file_in_test_folder_can_be_launch_file(workspace: Path) -> None:
    include = (
        "<launch><include file='$(find arm)/launch/load.launch'><arg name='side' value='left'/></include></launch>"
    )
    (workspace / "arm/test").mkdir()
    (workspace / "arm/test/roslaunch_arm.xml").write_text(include)
    text = "$(find xacro)/xacro $(find arm)/urdf/arm.urdf.xacro prefix:=$(arg side)_"
    load = f'<launch><arg name="side"/><param name="robot_description" command="{text}"/></launch>'
    assert certain_values(find_argument_sets(workspace, "arm/launch/load.launch", load)) == [{"prefix": "left_"}]


def test_undeclared_dependency_provides_values_only_as_fallback(workspace: Path) -> None:
    (workspace / "user/package.xml").write_text(MANIFEST.format(name="user", needs="xacro"))
    text = launch_file_text("default_value='far_'")
    assert certain_values(find_argument_sets(workspace, "user/launch/far.launch.py", text)) == [
        {"name": "robot", "prefix": "far_"}
    ]
    text = launch_file_text("default_value='near_'")
    assert certain_values(find_argument_sets(workspace, "arm/launch/near.launch.py", text)) == [
        {"name": "robot", "prefix": "near_"}
    ]


@pytest.mark.parametrize(
    ("mapping", "found"),
    [
        ("{'side': 'left'}", [{"prefix": "left"}]),
        ("{'other': 'left'}", [{"prefix": "right"}]),
        ("ask()", []),
        ("os.environ", [{"prefix": "right"}]),
        ("context.launch_configurations", [{"prefix": "right"}]),
    ],
)
def test_lookup_default_applies_only_if_key_is_known_to_be_missing(
    workspace: Path, mapping: str, found: list[dict[str, str]]
) -> None:
    text = f"""
import os
import xacro
from ament_index_python.packages import get_package_share_path

def setup(context):
    side = {mapping}.get('side', 'right')
    xacro.process_file(get_package_share_path('arm') / 'urdf/arm.urdf.xacro', mappings={{'prefix': side}})
"""
    assert certain_values(find_argument_sets(workspace, "arm/launch/look.launch.py", text)) == found


def test_repeatedly_combined_names_are_evaluated_once(workspace: Path) -> None:
    assignments = "\n".join(
        f"    a{i} = a{i} or ask(a{i})\n    a{i} = str(a{i - 1}) + str(a{i - 1})" for i in range(1, 28)
    )
    text = f"""
import xacro
from ament_index_python.packages import get_package_share_path

def setup(a0):
{assignments}
    xacro.process_file(get_package_share_path('arm') / 'urdf/arm.urdf.xacro', mappings={{'prefix': 'a', 'name': a27}})
"""
    argument_sets = find_argument_sets(workspace, "arm/launch/again.launch.py", text)
    assert [(dict(argument_set.values), argument_set.runtime_names) for argument_set in argument_sets] == [
        ({"prefix": "a"}, ("name",))
    ]


@pytest.mark.parametrize(("function", "prefix"), [("describe", "a b"), ("xacro.process_file", '"a b"')])
def test_helper_building_command_line_removes_quotes(workspace: Path, function: str, prefix: str) -> None:
    text = f"""
from ament_index_python.packages import get_package_share_path

def setup():
    {function}(get_package_share_path('arm') / 'urdf/arm.urdf.xacro', mappings={{'prefix': '"a b"'}})
"""
    assert certain_values(find_argument_sets(workspace, "arm/launch/quoted.launch.py", text)) == [{"prefix": prefix}]


@pytest.mark.parametrize(
    "condition", ["$(eval arg('arm') == '{}')", "$(eval arm == '{}')", "$(eval '$(var arm)' == '{}')"]
)
@pytest.mark.parametrize("default", ["arm", "hand"])
def test_the_argument_that_chooses_the_file_decides_conditional_defaults(workspace, condition, default):
    (workspace / "arm/urdf/hand.urdf.xacro").write_text(ROBOT)
    text = f"""<launch>
      <arg name="arm" default="{default}"/>
      <arg name="dof" default="7" if="{condition.format("hand")}"/>
      <arg name="dof" default="6" if="{condition.format("arm")}"/>
      <param name="a" command="xacro $(find arm)/urdf/$(arg arm).urdf.xacro dof:=$(arg dof)"/>
      <param name="b" command="xacro $(find arm)/urdf/$(arg arm)_$(arg gripper).urdf.xacro dof:=$(arg dof) wide:=1"/>
    </launch>"""
    assert [found.values for found in find_argument_sets(workspace, "user/launch/arm.launch", text)] == [{"dof": "6"}]
