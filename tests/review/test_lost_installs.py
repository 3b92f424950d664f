"""Files of the repository that still read files which a package no longer installs."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

CMAKE = """cmake_minimum_required(VERSION 3.8)
project(arm)
find_package(ament_cmake REQUIRED)
install(DIRECTORY config launch DESTINATION share/${PROJECT_NAME})
install(DIRECTORY include/ DESTINATION include)
ament_package()
"""
SETUP = """from glob import glob
from setuptools import setup
setup(name="arm", packages=["arm"], data_files=[
    ("share/arm", ["package.xml"]),
    ("share/arm/launch", glob("launch/*")),
    ("share/arm/config", glob("config/*")),
])
"""
PYTHON_LAUNCH = """import os
from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    file = os.path.join(get_package_share_path("arm"), "config", "gains.yaml")
    return LaunchDescription([Node(package="arm", executable="driver", parameters=[file])])
"""
FILES = {
    "a/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "a/arm/__init__.py": "",
    "a/config/gains.yaml": "driver: {ros__parameters: {gain: 1.0}}\n",
    "a/config/limits.yaml": "driver: {ros__parameters: {limit: 1.0}}\n",
    "a/launch/arm.launch.xml": "<launch/>\n",
    "a/include/arm/driver.hpp": "#define MOTORS 6\n",
    "b/package.xml": PACKAGE_XML.replace("arm_description", "cell"),
}
LOST = "names files of 'arm' that are no longer installed: "


def run(repository, compare, files, *, removed=("config ",), build=("a/CMakeLists.txt", CMAKE)):
    """Return the breaking changes of package 'cell' after package 'arm' installs less."""
    name, text = build
    repository.commit({**FILES, name: text, **files})
    for part in removed:
        assert part in text
        text = text.replace(part, "")
    repository.write({name: text})
    return compare(repository)


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        ("launch/cell.launch.py", PYTHON_LAUNCH, "'config/gains.yaml'"),
        ("launch/cell.launch.py", PYTHON_LAUNCH.replace('"gains.yaml"', "os.environ['GAINS']"), "'config'"),
        ("launch/cell.launch.xml", '<a from="$(find-pkg-share arm)/config/gains.yaml"/>', "'config/gains.yaml'"),
        ("launch/cell.launch.xml", '<a from="$(find-pkg-share arm)/config/$(var g).yaml"/>', "'config'"),
        ("launch/cell.launch.yaml", "from: $(find-pkg-share arm)/config/gains.yaml\n", "'config/gains.yaml'"),
        ("cell/node.py", "share = get_package_share_directory('arm')\nfile = share + '/config/gains.yaml'\n",
         "'config/gains.yaml'"),
        ("cell/node.py", "FILE = 'package://arm/config/gains.yaml'\n", "'config/gains.yaml'"),
        ("cell/node.py", "import os\nshare = get_package_share_path('arm')\nopen(share / 'config' / os.name)\n",
         "'config'"),
        ("src/node.cpp", 'auto f = ament_index_cpp::get_package_share_directory("arm") + "/config/gains.yaml";\n',
         "'config/gains.yaml'"),
        ("src/node.cpp", 'std::string s(get_package_share_directory("arm"));\nread(s + "/config/" + name);\n',
         "'config'"),
        ("config/cell.rviz", "File: package://arm/config/gains.yaml\n", "'config/gains.yaml'"),
        ("start.sh", "ros2 run x y $(ros2 pkg prefix arm)/share/arm/config/gains.yaml\n", "'config/gains.yaml'"),
    ],
)  # fmt: skip
def test_file_that_names_an_uninstalled_file_is_reported(repository, compare, path, text, expected):
    result = run(repository, compare, {f"b/{path}": text})
    assert sentences(subject(result, f"b/{path}")) == [f"{LOST}{expected}"]


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("launch/cell.launch.xml", '<!-- $(find-pkg-share arm)/config/gains.yaml --><a from="b"/>'),
        ("launch/cell.launch.xml", '<a from="$(find-pkg-share arm)/launch/arm.launch.xml"/>'),
        ("launch/cell.launch.xml", '<a from="$(find-pkg-share other)/config/gains.yaml"/>'),
        ("launch/cell.launch.xml", '<a from="$(find-pkg-share arm)/$(var file)"/>'),
        ("cell/node.py", "share = get_package_share_directory('arm')\n"),
        ("cell/node.py", "# 'package://arm/config/gains.yaml'\n"),
        ("cell/node.py", "def broken(:\n    'package://arm/config/gains.yaml'\n"),
        ("test/node.py", "FILE = 'package://arm/config/gains.yaml'\n"),
        ("src/node.cpp", '// "package://arm/config/gains.yaml"\n'),
        ("src/node.cpp", '#include <arm/driver.hpp>\n'),
    ],
)  # fmt: skip
def test_file_that_names_only_installed_files_is_not_reported(repository, compare, path, text):
    result = run(repository, compare, {f"b/{path}": text})
    assert [found.path for found in result.subjects] == ["a/CMakeLists.txt"]


def test_folder_that_keeps_files_is_not_lost(repository, compare):
    cmake = CMAKE.replace("DIRECTORY config launch", "FILES config/gains.yaml config/limits.yaml").replace(
        "share/${PROJECT_NAME}", "share/${PROJECT_NAME}/config"
    )
    launch = '<a from="$(find-pkg-share arm)/config/$(var name)"/><a from="$(find-pkg-share arm)/config/gains.yaml"/>'
    files = {"b/launch/cell.launch.xml": launch}
    result = run(repository, compare, files, removed=("config/gains.yaml ",), build=("a/CMakeLists.txt", cmake))
    assert sentences(subject(result, "b/launch/cell.launch.xml")) == [f"{LOST}'config/gains.yaml'"]


def test_files_that_setup_no_longer_installs_are_reported(repository, compare):
    files = {"b/launch/cell.launch.py": PYTHON_LAUNCH}
    line = '    ("share/arm/config", glob("config/*")),\n'
    result = run(repository, compare, files, removed=(line,), build=("a/setup.py", SETUP))
    assert breaking(result) == ["no longer installed: 'share/arm/config/'", f"{LOST}'config/gains.yaml'"]


def test_file_of_the_same_package_is_reported(repository, compare):
    result = run(repository, compare, {"a/launch/cell.launch.py": PYTHON_LAUNCH})
    (change,) = subject(result, "a/launch/cell.launch.py").changes
    assert str(change.sentence) == f"{LOST}'config/gains.yaml'"
    assert (change.location.line, str(change.reason)) == (7, "it does not find the files")


def test_ros1_package_finds_the_file_in_its_source_folder(repository, compare):
    cmake = "project(arm)\nfind_package(catkin REQUIRED)\ncatkin_package()\ninstall(DIRECTORY config launch\n"
    cmake += "  DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})\n"
    manifest = FILES["a/package.xml"].replace("<license>", "<buildtool_depend>catkin</buildtool_depend><license>")
    files = {"a/package.xml": manifest, "b/launch/cell.launch": '<a file="$(find arm)/config/gains.yaml"/>'}
    result = run(repository, compare, files, build=("a/CMakeLists.txt", cmake))
    (change,) = subject(result, "b/launch/cell.launch").changes
    assert str(change.reason) == "it does not find the files in an installed workspace"


def test_source_that_includes_an_uninstalled_header_is_reported(repository, compare):
    files = {"b/src/node.cpp": "#include <arm/driver.hpp>\n", "a/src/arm.cpp": "#include <arm/driver.hpp>\n"}
    result = run(repository, compare, files, removed=("install(DIRECTORY include/ DESTINATION include)\n",))
    assert breaking(result) == [
        "no longer installed: 'include/arm/driver.hpp'",
        "includes headers of 'arm' that are no longer installed: 'arm/driver.hpp'",
    ]
    assert result.breaking_changes[1][0].path == "b/src/node.cpp"


def test_header_that_the_including_package_has_is_not_lost(repository, compare):
    files = {"b/src/node.cpp": "#include <arm/driver.hpp>\n", "b/include/arm/driver.hpp": "#define MOTORS 6\n"}
    result = run(repository, compare, files, removed=("install(DIRECTORY include/ DESTINATION include)\n",))
    assert breaking(result) == ["no longer installed: 'include/arm/driver.hpp'"]


def test_removed_file_that_another_package_names_is_reported_once(repository, compare):
    launch = '<a from="$(find-pkg-share arm)/config/gains.yaml"/>'
    node = "FILE = 'package://arm/config/gains.yaml'\n"
    repository.commit({**FILES, "a/CMakeLists.txt": CMAKE, "b/launch/cell.launch.xml": launch, "b/cell/node.py": node})
    repository.write({"a/config/gains.yaml": None})
    result = compare(repository)
    assert sentences(subject(result, "b/cell/node.py")) == [f"{LOST}'config/gains.yaml'"]
    assert sentences(subject(result, "b/launch/cell.launch.xml")) == [
        "names 'config/gains.yaml' of 'arm', which no longer exists"
    ]


OLD_ROBOT = (
    '<robot name="a"><link name="l"><visual><geometry><mesh filename="FILE"/></geometry></visual></link></robot>\n'
)


@pytest.mark.parametrize(
    ("build", "file", "is_found"),
    [
        (CMAKE, "package://arm/simulation/base.stl", False),
        (CMAKE, "package://arm/config/gains.yaml", True),
        (CMAKE, "package://arm/simulation/absent.stl", True),
        (CMAKE, "package://arm/meshes/base.stl", True),
        (CMAKE.replace("config launch", "config simulation"), "package://arm/simulation/base.stl", True),
        (CMAKE.replace("config launch", "${FOLDERS}"), "package://arm/simulation/base.stl", True),
    ],
)
def test_description_that_newly_names_a_folder_which_is_not_installed(repository, compare, build, file, is_found):
    path = "a/config/arm.urdf"
    meshes = {"a/simulation/base.stl": "solid\n", "a/meshes/base.stl": "solid\n"}
    old = OLD_ROBOT.replace("FILE", "package://arm/config/base.stl")
    repository.commit({**FILES, **meshes, "a/CMakeLists.txt": build, path: old})
    repository.write({path: OLD_ROBOT.replace("FILE", file)})
    text = "names files that 'arm' does not install: 'simulation/base.stl'"
    assert (text not in breaking(compare(repository))) is is_found


@pytest.mark.parametrize(
    ("name", "is_breaking"), [("gains.yaml.orig", False), ("__pycache__/arm.pyc", False), ("gains.txt", True)]
)
def test_installed_files_that_programs_leave_are_not_missed(repository, compare, name, is_breaking):
    files = {**FILES, "a/CMakeLists.txt": CMAKE, f"a/config/{name}": "gain: 1\n"}
    repository.commit(files)
    repository.write({f"a/config/{name}": None})
    assert any("no longer installed" in line for line in breaking(compare(repository))) is is_breaking
