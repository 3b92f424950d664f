"""Arguments that included launch files of ROS 2 take from the file that includes them, in a review."""

from __future__ import annotations

import re

import pytest

from linkwright.cli import main
from linkwright.packages.share_layout import iterate_substitutes
from linkwright.review.launches.common_files import find_known_arguments
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/launch/arm.launch.py"
FILE = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, RegisterEventHandler
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    first = Node(package="arm", executable="first")
    return LaunchDescription([
        DeclareLaunchArgument("hand", default_value="false"),
        {declared}
        first,
        {action},
    ])
"""
NODE = 'Node(package="arm", executable="hand", condition=IfCondition(LaunchConfiguration("hand")))'
INCLUDE = """IncludeLaunchDescription(PythonLaunchDescriptionSource(
            PathJoinSubstitution([FindPackageShare("arm"), "launch", "more.launch.py"]))"""
EVENT = "RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[{include})]))"
MORE = """from launch import LaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package="arm", executable="hand", {settings})])
"""
CONDITION = 'condition=IfCondition(LaunchConfiguration("hand"))'
NAMESPACE = 'namespace=LaunchConfiguration("ns")'
MISSING = "include of '$(find-pkg-share arm)/launch/more.launch.py' uses argument 'ns', which is not declared"


@pytest.fixture
def review_include(repository, compare):
    """Review a node that moves into an included file, and return the review."""

    def run(settings: str, include: str = INCLUDE + ")", declared: str = "", others: dict[str, str] | None = None):
        files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), **(others or {})}
        repository.commit({PATH: FILE.format(declared="", action=NODE), **files})
        new = FILE.format(declared=declared, action=include)
        repository.write({PATH: new, "arm/launch/more.launch.py": MORE.replace("{settings}", settings)})
        return compare(repository)

    return run


@pytest.mark.parametrize("include", [INCLUDE + ")", EVENT.replace("{include}", INCLUDE)])
@pytest.mark.parametrize("is_used", [True, False])
def test_argument_that_an_included_file_uses_is_used(review_include, include, is_used):
    result = review_include(CONDITION if is_used else "", include)
    assert ("argument 'hand' is no longer used" in breaking(result)) != is_used, breaking(result)


@pytest.mark.parametrize(
    ("include", "declared", "is_missing"),
    [
        (INCLUDE + ")", "", True),
        (EVENT.replace("{include}", INCLUDE), "", True),
        (INCLUDE + ', launch_arguments={"ns": "left"}.items())', "", False),
        (INCLUDE + ")", 'DeclareLaunchArgument("ns", default_value=""),', False),
    ],
)
def test_argument_that_nothing_gives_to_an_included_file(review_include, include, declared, is_missing):
    result = review_include(f"{CONDITION}, {NAMESPACE}", include, declared)
    assert (MISSING in breaking(result)) == is_missing
    if is_missing:
        (change,) = [change for change in subject(result, PATH).changes if str(change.sentence) == MISSING]
        assert str(change.reason) == "the launch file fails if no other file declares 'ns'"


@pytest.mark.parametrize("package", ["arm", "other"])
def test_file_of_another_package_with_the_same_name_is_not_included(review_include, package):
    caller = FILE.format(
        declared='DeclareLaunchArgument("ns", default_value=""),',
        action=INCLUDE.replace('"arm"', f'"{package}"').replace("more.launch.py", "arm.launch.py") + ")",
    )
    others = {
        "arm/launch/all.launch.py": caller,
        "other/package.xml": PACKAGE_XML.replace("arm_description", "other"),
        "other/launch/arm.launch.py": MORE.replace("{settings}", ""),
    }
    result = review_include(f"{CONDITION}, {NAMESPACE}", others=others)
    assert (MISSING in breaking(result)) == (package == "other")


def test_argument_that_was_missing_before_is_no_change(repository, compare):
    more = {
        "arm/launch/more.launch.py": MORE.replace("{settings}", NAMESPACE),
        "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    }
    include = INCLUDE + ")"
    repository.commit({PATH: FILE.format(declared="", action=include), **more})
    repository.write({PATH: FILE.format(declared="", action=include).replace('"first"', '"second"', 1)})
    assert not [text for each in compare(repository).subjects for text in sentences(each) if "not declared" in text]


SIMULATION = """IncludeLaunchDescription(PythonLaunchDescriptionSource(
            PathJoinSubstitution([FindPackageShare("PACKAGE"), "launch", "gz_sim.launch.py"])))"""
UNDECLARED = "node 'arm/tool' uses argument 'tool', which is not declared"
MAYBE_DECLARED = "node 'arm/tool' uses argument 'tool', which no launch file of the repository declares"
TOOL = 'Node(package="arm", executable="tool", condition=IfCondition(LaunchConfiguration("{name}")))'


@pytest.mark.parametrize(
    ("include", "name", "expected"),
    [
        (SIMULATION.replace("PACKAGE", "ros_gz_sim"), "tool", UNDECLARED),
        (SIMULATION.replace("PACKAGE", "ros_gz_sim"), "gz_args", MAYBE_DECLARED.replace("'tool',", "'gz_args',")),
        (SIMULATION.replace("PACKAGE", "other"), "tool", MAYBE_DECLARED),
        (f"GroupAction([{SIMULATION}])".replace("PACKAGE", "other"), "tool", UNDECLARED),
        (f"GroupAction([{SIMULATION}], scoped=False)".replace("PACKAGE", "other"), "tool", MAYBE_DECLARED),
    ],
)
def test_argument_that_an_included_file_of_another_package_may_declare(repository, compare, include, name, expected):
    old = FILE.format(declared="", action=include).replace("import Declare", "import GroupAction, Declare")
    repository.commit({PATH: old, "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")})
    repository.write({PATH: old.replace(f"{include},", f"{include},\n        {TOOL.replace('{name}', name)},")})
    result = compare(repository)
    assert expected in sentences(subject(result, PATH))
    assert (expected in breaking(result)) == (expected == UNDECLARED)


LATER = """from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription, OpaqueFunction
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def start_tools(context):
    return []


def generate_launch_description():
    include = INCLUDE
    return LaunchDescription([include, OpaqueFunction(function=start_tools)])
"""


@pytest.mark.parametrize(("package", "is_certain"), [("other", False), ("ros_gz_sim", True)])
def test_include_below_the_action_in_python_may_start_before_it(repository, compare, package, is_certain):
    old = LATER.replace("INCLUDE", SIMULATION.replace("PACKAGE", package))
    repository.commit({PATH: old, "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")})
    repository.write({PATH: old.replace("return []", f"return [{TOOL.replace('{name}', 'tool')}]")})
    found = sentences(subject(compare(repository), PATH))
    assert (UNDECLARED if is_certain else MAYBE_DECLARED) in found


INNER = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("size", default_value="3"),
        Node(package="arm", executable="arm", parameters=[{"size": LaunchConfiguration("size")}]),
    ])
"""
OUTER = """<launch>
  <arg name="size" default="{default}" />
  <include file="$(find-pkg-share arm)/launch/inner.launch.py">
    <arg name="size" value="$(var size)" />
  </include>
</launch>
"""
PASSED = '    <arg name="size" value="$(var size)" />\n'


@pytest.mark.parametrize(
    ("default", "replaced", "expected"),
    [
        ("3", PASSED, "argument 'size' removed: default 3; arm/launch/inner.launch.py declares it"),
        (
            "4",
            PASSED,
            "argument 'size' removed: default 4; arm/launch/inner.launch.py declares it with the default '3'",
        ),
        ("3", '"$(var size)"', None),
    ],
)
def test_included_file_still_gets_a_value_that_the_outer_file_no_longer_declares(
    repository, compare, default, replaced, expected
):
    path, text = "arm/launch/outer.launch.xml", OUTER.format(default=default)
    inner = {"arm/launch/inner.launch.py": INNER, "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
    repository.commit({path: text, **inner})
    declared = f'  <arg name="size" default="{default}" />\n'
    repository.write({path: text.replace(declared, "").replace(replaced, '"5"' if expected is None else "")})
    result = compare(repository)
    if expected is None:
        assert breaking(result) == [f"argument 'size' removed: default {default}"]
    else:
        assert expected in sentences(subject(result, path))
        assert breaking(result) == []


GROUPS = """<launch>
  <group{scoped}>
    <include file="$(find-pkg-share other)/launch/other.launch.xml" />
  </group>
{node}</launch>
"""


@pytest.mark.parametrize(("scoped", "expected"), [("", UNDECLARED), (' scoped="false"', MAYBE_DECLARED)])
def test_include_in_a_group_of_xml_declares_nothing_outside(repository, compare, scoped, expected):
    path = "arm/launch/arm.launch.xml"
    repository.commit({path: GROUPS.format(scoped=scoped, node="")})
    node = '  <node pkg="arm" exec="tool" if="$(var tool)" />\n'
    repository.write({path: GROUPS.format(scoped=scoped, node=node)})
    assert expected in sentences(subject(compare(repository), path))


@pytest.mark.parametrize("package", ["nav2_bringup", "ros_gz_sim", "ros_gz_bridge", "gazebo_ros", "slam_toolbox"])
def test_known_arguments_contain_those_of_the_substitutes(package, capsys):
    share = next(share for name, share in iterate_substitutes() if name == package)
    for file in sorted((share / "launch").glob("*.py")):
        assert main(["launch", str(file), "--show-args"]) == 0
        declared = re.findall(r"^ *'(\w+)'", capsys.readouterr().out, re.MULTILINE)
        known = find_known_arguments(f"$(find-pkg-share {package})/launch/{file.name}")
        assert known is not None
        assert known >= set(declared)


PAL = """from launch import LaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_pal.include_utils import include_launch_py_description


def generate_launch_description():
    description = LaunchDescription()
    {action}
    return description
"""
PAL_ACTION = """hand = include_launch_py_description(
        "hand_bringup", ["launch", "hand.launch.py"],
        condition=IfCondition(LaunchConfiguration("hand", default="true")))
    description.add_action(hand)"""


def test_function_of_another_package_that_includes_a_file_is_an_include(repository, compare):
    repository.commit({PATH: PAL.format(action="pass"), "arm/package.xml": PACKAGE_XML})
    repository.write({PATH: PAL.format(action=PAL_ACTION)})
    (text,) = [text for text in sentences(subject(compare(repository), PATH)) if "include" in text]
    assert text.startswith("include of '$(find-pkg-share hand_bringup)/launch/hand.launch.py' added: if $(var hand")


MOVEIT = """from launch import LaunchDescription
from launch.actions import OpaqueFunction
from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import generate_move_group_launch


def setup(context):
    config = MoveItConfigsBuilder("arm").to_moveit_configs()
    return [{action}]


def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=setup)])
"""


def test_function_of_moveit_that_a_function_calls_is_an_action(repository, compare):
    repository.commit({PATH: MOVEIT.format(action=""), "arm/package.xml": PACKAGE_XML})
    repository.write({PATH: MOVEIT.format(action="generate_move_group_launch(config)")})
    texts = [text for text in sentences(subject(compare(repository), PATH)) if "generate_move_group_launch" in text]
    assert texts
    assert texts[0].startswith("action 'generate_move_group_launch' added")


BRIDGED = """<launch>
{arguments}{include}</launch>
"""


@pytest.mark.parametrize("count", [2, 3])
def test_arguments_of_a_removed_include_are_one_line(repository, compare, count):
    path, names = "arm/launch/arm.launch.xml", ["port", "address", "debug"][:count]
    arguments = "".join(f'  <arg name="{name}" default="1"/>\n' for name in names)
    passed = "".join(f'<arg name="{name}" value="$(var {name})"/>' for name in names)
    include = f'  <include file="$(find-pkg-share bridge)/launch/a.launch.xml">{passed}</include>\n'
    repository.commit({path: BRIDGED.format(arguments=arguments, include=include)})
    repository.write({path: BRIDGED.format(arguments="", include="")})
    found = [text for text in breaking(compare(repository)) if "argument" in text.split(",")[0]]
    together = (
        "arguments removed with include of '$(find-pkg-share bridge)/launch/a.launch.xml': 'port', 'address', 'debug'"
    )
    assert (found == [together]) is (count == 3)
    assert len(found) == (1 if count == 3 else 2)


@pytest.mark.parametrize(
    ("suffix", "attribute", "is_lost"), [("", "", True), ("", 'pass_all_args="true"', False), (".xml", "", False)]
)
def test_an_argument_moves_to_an_included_file(repository, compare, suffix, attribute, is_lost):
    find, kind, value = ("find-pkg-share", "exec", "$(var match)") if suffix else ("find", "type", "$(arg match)")
    argument = '<arg name="match" default="true"/>'
    node = f'<node pkg="match" {kind}="match" name="match" args="{value}"/>'
    path, included = f"arm/launch/arm.launch{suffix}", f"arm/launch/lidar.launch{suffix}"
    include = f'<include file="$({find} arm)/launch/lidar.launch{suffix}" {attribute}/>'
    manifest = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
    repository.commit({**manifest, path: f"<launch>{argument}{include}{node}</launch>", included: "<launch/>"})
    repository.write({path: f"<launch>{include}</launch>", included: f"<launch>{argument}{node}</launch>"})
    assert (f"argument 'match' moved to {included}" in breaking(compare(repository))) == is_lost
