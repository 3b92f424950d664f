"""The lines of a review about launch files of all formats that name missing files, and about tests of ROS 1."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

CMAKE = """cmake_minimum_required(VERSION 3.8)
project(arm)
install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})
"""
XML = '<launch><node pkg="a" exec="b"><param from="$(find-pkg-share arm)/config/arm.yaml"/></node></launch>\n'
ROS1 = '<launch><rosparam file="$(find arm)/config/arm.yaml"/></launch>\n'
YAML = 'launch:\n- node: {pkg: a, exec: b, param: [{from: "$(find-pkg-share arm)/config/arm.yaml"}]}\n'
PYTHON = """from launch import LaunchDescription
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare
from launch.substitutions import PathJoinSubstitution


def generate_launch_description():
    file = PathJoinSubstitution([FindPackageShare("arm"), "config", "arm.yaml"])
    return LaunchDescription([Node(package="a", executable="b", parameters=[file])])
"""
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/CMakeLists.txt": CMAKE,
    "arm/config/arm.yaml": "a: 1\n",
}
FORMATS = [
    ("arm.launch.xml", XML), ("included.xml", XML), ("arm.launch", ROS1), ("arm.test", ROS1),
    ("arm_launch.yaml", YAML), ("included.yaml", YAML),
]  # fmt: skip


@pytest.mark.parametrize(("name", "text"), [*FORMATS, ("arm.launch.py", PYTHON), ("simulation.py", PYTHON)])
@pytest.mark.parametrize("new_name", [None, "arm/config/robot.yaml"])
def test_launch_file_of_any_format_that_names_a_lost_file_is_told(repository, compare, name, text, new_name):
    repository.commit({**FILES, f"arm/launch/{name}": text})
    repository.write({"arm/config/arm.yaml": None, **({new_name: "a: 1\n"} if new_name else {})})
    found = sentences(subject(compare(repository), f"arm/launch/{name}"))
    assert found == ["names 'config/arm.yaml' of 'arm', which no longer exists"]


@pytest.mark.parametrize(("name", "text"), [*FORMATS, ("arm.launch.py", PYTHON)])
def test_launch_file_that_newly_names_a_missing_file_is_breaking(repository, compare, name, text):
    repository.commit({**FILES, f"arm/launch/{name}": text})
    repository.write({f"arm/launch/{name}": text.replace("arm.yaml", "robot.yaml")})
    result = compare(repository)
    assert breaking(result) == ["names 'config/robot.yaml' of 'arm', which does not exist"]
    assert not any(finding.code == "LW842" for finding in result.new_findings)  # the line tells it


def test_launch_file_that_checks_which_files_exist_may_name_a_missing_one(repository, compare):
    checking = PYTHON.replace("    return", "    if not os.path.isfile(file):\n        file = None\n    return")
    repository.commit({**FILES, "arm/launch/arm.launch.py": checking})
    repository.write({"arm/launch/arm.launch.py": checking.replace("arm.yaml", "robot.yaml")})
    assert breaking(compare(repository)) == []


@pytest.mark.parametrize(
    ("statement", "may_exist"),
    [
        ("with open(file) as stream: load(stream)", False),
        ("with open(file, 'w') as stream: save(stream)", True),
        ("shutil.copyfile('a.yaml', file)", True),
        ("try: load(open(file))\n    except OSError: file = None", True),
    ],
)
def test_launch_file_that_only_reads_files_needs_the_missing_one(repository, compare, statement, may_exist):
    reading = PYTHON.replace("    return", f"    {statement}\n    return")
    repository.commit({**FILES, "arm/launch/arm.launch.py": reading})
    repository.write({"arm/launch/arm.launch.py": reading.replace("arm.yaml", "robot.yaml")})
    told = ["names 'config/robot.yaml' of 'arm', which does not exist"]
    assert breaking(compare(repository)) == ([] if may_exist else told)


@pytest.mark.parametrize(
    "changes",
    [
        {"arm/config/robot.yaml": "a: 1\n"},
        {"arm/CMakeLists.txt": CMAKE + "configure_file(a.in config/robot.yaml)\n"},
        {".gitignore": "robot.yaml\n"},
        {".gitignore": "arm/**/*bot.y*ml\n"},
        {"arm/.gitignore": "/config/r*\n"},
        {"arm/launch/arm.launch.xml": XML.replace("arm.yaml", "$(env NAME x).yaml")},
        {"arm/launch/arm.launch.xml": XML.replace("<node", '<!-- "$(find-pkg-share arm)/config/x.yaml" --><node')},
    ],
)
def test_file_that_may_exist_is_not_told(repository, compare, changes):
    new = XML.replace("arm.yaml", "robot.yaml")
    repository.commit({**FILES, "arm/launch/arm.launch.xml": XML})
    repository.write({"arm/launch/arm.launch.xml": new, **changes})
    assert breaking(compare(repository)) == []


@pytest.mark.parametrize(
    ("command", "may_make"),
    [
        ('install(CODE "execute_process(COMMAND chmod +x ${CMAKE_INSTALL_PREFIX}/lib/arm/run)")', False),
        ('install(CODE "execute_process(COMMAND \\"/usr/bin/python3\\" -m compileall \\"${FOLDER}\\")")', False),
        ("execute_process(COMMAND git -C ${FOLDER} rev-parse --short HEAD OUTPUT_VARIABLE revision)", False),
        ('execute_process(COMMAND ${PYTHON} -c "import numpy; print(numpy.get_include())" OUTPUT_VARIABLE a)', False),
        ('execute_process(COMMAND ${PYTHON} -c "import numpy; print(make_files()); save()")', True),
        ("execute_process(COMMAND git archive HEAD)", True),
        ("execute_process(COMMAND date OUTPUT_FILE ${FILE})", True),
        ("execute_process(COMMAND date COMMAND scripts/make_files.sh)", True),
        ("execute_process(COMMAND date)\nexecute_process(COMMAND scripts/make_files.sh)", True),
        ('install(CODE "execute_process(COMMAND scripts/make_files.sh)")', True),
    ],
)
def test_process_that_only_tells_a_fact_makes_no_missing_file(repository, compare, command, may_make):
    repository.commit({**FILES, "arm/CMakeLists.txt": f"{CMAKE}{command}\n", "arm/launch/arm.launch.xml": XML})
    repository.write({"arm/launch/arm.launch.xml": XML.replace("arm.yaml", "robot.yaml")})
    told = ["names 'config/robot.yaml' of 'arm', which does not exist"]
    assert breaking(compare(repository)) == ([] if may_make else told)


LEFT_OUT = CMAKE.replace("launch config", "launch")
CATKIN = """<package format="2"><name>arm</name><version>1.0.0</version>
  <buildtool_depend>catkin</buildtool_depend></package>
"""


@pytest.mark.parametrize(
    ("changes", "reasons"),
    [
        ({}, ["the launch file does not find the file"]),
        ({"arm/package.xml": CATKIN}, ["the launch file does not find the file in an installed workspace"]),
        ({"arm/CMakeLists.txt": CMAKE}, []),
        (
            {"arm/CMakeLists.txt": LEFT_OUT + "externalproject_add(driver)\n"},
            ["the launch file does not find the file"],
        ),
        ({"arm/CMakeLists.txt": LEFT_OUT + "externalproject_add(config)\n"}, []),
        ({"arm/CMakeLists.txt": LEFT_OUT.replace(" launch ", " meshes ")}, []),
    ],
)
def test_launch_file_that_newly_names_a_file_which_is_not_installed(repository, compare, changes, reasons):
    text = XML.replace("config/arm", "launch/arm")
    files = {**FILES, "arm/launch/arm.yaml": "a: 1\n", "arm/CMakeLists.txt": LEFT_OUT, **changes}
    repository.commit({**files, "arm/launch/arm.launch.xml": text})
    repository.write({"arm/launch/arm.launch.xml": XML})
    assert [str(change.reason) for _, change in compare(repository).breaking_changes] == reasons


def test_missing_file_of_an_added_launch_file_breaks_nobody(repository, compare):
    repository.commit(FILES)
    repository.write({"arm/launch/arm.launch.xml": XML.replace("arm.yaml", "robot.yaml")})
    result = compare(repository)
    assert "names 'config/robot.yaml' of 'arm', which does not exist" in sentences(
        subject(result, "arm/launch/arm.launch.xml")
    )
    assert breaking(result) == []


def test_a_pattern_that_only_contains_the_name_of_a_folder_does_not_hide_a_missing_file(repository, compare):
    repository.commit({**FILES, ".gitignore": ".installed.config\n", "arm/launch/arm.launch.xml": XML})
    repository.commit({"arm/launch/arm.launch.xml": XML.replace("config/arm", "installed/robot")})
    result = compare(repository, "HEAD~..HEAD")
    assert breaking(result) == ["names 'installed/robot.yaml' of 'arm', which does not exist"]


TEST = """<launch>
  <node pkg="arm" type="driver" name="driver"/>
  <test test-name="rate" pkg="rostest" type="hztest" name="rate" time-limit="60"><param name="hz" value="5"/></test>
</launch>
"""


@pytest.mark.parametrize("path", ["arm/test/arm.test", "arm/launch/arm.launch"])
def test_tests_of_ros1_are_compared_like_nodes(repository, compare, path):
    repository.commit({"arm/package.xml": PACKAGE_XML, path: TEST})
    repository.write({path: TEST.replace('value="5"', 'value="6"').replace('"60"', '"90"')})
    result = compare(repository)
    expected = ["test 'rostest/hztest': time-limit 60 -> 90", "test 'rostest/hztest': parameter hz 5 -> 6"]
    assert sentences(subject(result, path)) == expected
    assert breaking(result) == []


@pytest.mark.parametrize("is_added", [True, False])
def test_added_and_removed_files_of_tests_are_shown_with_their_actions(repository, compare, is_added):
    repository.commit({"arm/package.xml": PACKAGE_XML, **({} if is_added else {"arm/test/arm.test": TEST})})
    repository.write({"arm/test/arm.test": TEST if is_added else None})
    result = compare(repository)
    (sentence,) = sentences(subject(result, "arm/test/arm.test"))
    test = "test 'rostest/hztest' (name rate, parameter hz 5, test-name rate, time-limit 60)"
    assert sentence == f"test {'added' if is_added else 'removed'}: node 'arm/driver' (name driver), {test}"
    assert breaking(result) == []


def test_node_that_a_test_no_longer_starts_is_not_breaking(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/test/arm.test": TEST})
    repository.write({"arm/test/arm.test": TEST.replace('  <node pkg="arm" type="driver" name="driver"/>\n', "")})
    result = compare(repository)
    assert sentences(subject(result, "arm/test/arm.test")) == ["node 'arm/driver' removed: name driver"]
    assert breaking(result) == []


HELPER = """from launch_ros.actions import Node


def make():
    return Node(package="a", executable="b")
"""


@pytest.mark.parametrize(
    ("text", "line"),
    [(PYTHON, "launch file removed: node 'a/b'"), (HELPER, "functions for launch files removed")],
)
def test_python_file_with_a_launch_description_is_a_launch_file_whatever_its_name(repository, compare, text, line):
    repository.commit({**FILES, "arm/launch/simulation.py": text})
    repository.write({"arm/launch/simulation.py": None})
    (sentence,) = sentences(subject(compare(repository), "arm/launch/simulation.py"))
    assert sentence == line


@pytest.mark.parametrize("text", ["path.__str__()", "path.as_posix()", "str(path)"])
def test_the_text_of_a_path_object_is_the_path(review_changes, text):
    launch = (
        "from pathlib import Path\nfrom launch import LaunchDescription\n"
        "from launch.actions import IncludeLaunchDescription\n\n\n"
        "def generate_launch_description():\n"
        "    path = Path(get_package_share_directory('arm')) / 'launch' / 'base.launch.py'\n"
        "    return LaunchDescription([IncludeLaunchDescription(path)])\n"
    )
    assert review_changes("a.launch.py", launch, "Description(path)", f"Description({text})") == ([], [])


@pytest.mark.parametrize(("root", "is_told"), [("launch", True), ("launchConfiguration", False)])
def test_the_root_element_tells_whether_a_file_is_a_launch_file(repository, compare, root, is_told):
    path = "arm/board/debug.launch"
    repository.commit(FILES)
    repository.write({path: f'<?xml version="1.0"?>\n<!-- debug -->\n<{root} type="debug"></{root}>\n'})
    result = compare(repository)
    assert [found.path for found in result.subjects] == ([path] if is_told else [])
    assert list(result.other_files) == ([] if is_told else [path])


JOYSTICKS = {
    "arm.launch.xml": """<launch>
<arg name="use_joy" default="false"/>
<node pkg="joy" exec="joy" if="$(var use_joy)"><param from="$(find-pkg-share arm)/config/joy.yaml"/></node>
</launch>
""",
    "arm.launch": """<launch>
<arg name="use_joy" default="false"/>
<group if="$(arg use_joy)">
<node name="joy" pkg="joy" type="joy"><rosparam file="$(find arm)/config/joy.yaml"/></node>
</group>
</launch>
""",
    "arm.launch.py": """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    file = PathJoinSubstitution([FindPackageShare("arm"), "config", "joy.yaml"])
    condition = IfCondition(LaunchConfiguration("use_joy"))
    return LaunchDescription([
        DeclareLaunchArgument("use_joy", default_value="false"),
        Node(package="joy", executable="joy", parameters=[file], condition=condition),
    ])
""",
}
NO_JOYSTICKS = {
    "arm.launch.xml": "<launch/>\n",
    "arm.launch": "<launch/>\n",
    "arm.launch.py": "from launch import LaunchDescription\n\n\n"
    "def generate_launch_description():\n    return LaunchDescription([])\n",
}
MISSING = "names 'config/joy.yaml' of 'arm', which does not exist"


def review_joystick(repository, compare, name, new_text, old_text=None, others=None):
    old_text = NO_JOYSTICKS[name] if old_text is None else old_text
    repository.commit({**FILES, **(others or {}), f"arm/launch/{name}": old_text})
    repository.write({f"arm/launch/{name}": new_text})
    return compare(repository)


@pytest.mark.parametrize("name", JOYSTICKS)
def test_missing_file_of_an_added_node_that_a_new_argument_switches_off_is_not_breaking(repository, compare, name):
    result = review_joystick(repository, compare, name, JOYSTICKS[name])
    assert MISSING in sentences(subject(result, f"arm/launch/{name}"))
    assert MISSING not in breaking(result)


@pytest.mark.parametrize("name", JOYSTICKS)
def test_missing_file_of_a_node_that_starts_by_default_is_breaking(repository, compare, name):
    result = review_joystick(repository, compare, name, JOYSTICKS[name].replace("false", "true"))
    assert MISSING in breaking(result)


@pytest.mark.parametrize("name", JOYSTICKS)
def test_missing_file_of_a_node_that_an_old_argument_switches_off_is_breaking(repository, compare, name):
    lines = JOYSTICKS[name].splitlines(keepends=True)
    old_text = "".join(line for line in lines if not any(word in line for word in ("<node", "Node(", "file = ")))
    result = review_joystick(repository, compare, name, JOYSTICKS[name], old_text)
    assert MISSING in breaking(result)  # users start the file with this argument


@pytest.mark.parametrize("name", JOYSTICKS)
def test_missing_file_of_a_node_of_the_old_version_is_breaking(repository, compare, name):
    old_text = JOYSTICKS[name].replace("use_joy", "joystick").replace("joy.yaml", "arm.yaml")
    result = review_joystick(repository, compare, name, JOYSTICKS[name], old_text)
    assert MISSING in breaking(result)


@pytest.mark.parametrize("name", JOYSTICKS)
def test_missing_file_of_a_node_that_another_launch_file_switches_on_is_breaking(repository, compare, name):
    include = f'<include file="$(find-pkg-share arm)/launch/{name}"><arg name="use_joy" value="1"/></include>'
    caller = f"<launch>{include}</launch>\n"
    others = {"arm/launch/all.launch.xml": caller}
    assert MISSING in breaking(review_joystick(repository, compare, name, JOYSTICKS[name], others=others))


def test_missing_file_that_a_python_file_reads_in_any_case_is_breaking(repository, compare):
    text = JOYSTICKS["arm.launch.py"].replace("[file]", "[yaml.safe_load(open(file))]").replace(
        'PathJoinSubstitution([FindPackageShare("arm"), "config", "joy.yaml"])',
        'os.path.join(get_package_share_directory("arm"), "config", "joy.yaml")',
    )  # fmt: skip
    assert MISSING in breaking(review_joystick(repository, compare, "arm.launch.py", text))


def test_missing_file_that_an_included_file_can_use_is_breaking(repository, compare):
    text = """<launch>
<arg name="joy_file" default="$(find-pkg-share arm)/config/joy.yaml"/>
<arg name="use_joy" default="false"/>
<node pkg="joy" exec="joy" if="$(var use_joy)"><param from="$(var joy_file)"/></node>
</launch>
"""
    name = "arm.launch.xml"
    assert MISSING not in breaking(review_joystick(repository, compare, name, text))
    text = text.replace("</launch>", '<include file="$(find-pkg-share other)/launch/other.launch.xml"/></launch>')
    assert MISSING in breaking(review_joystick(repository, compare, name, text))
