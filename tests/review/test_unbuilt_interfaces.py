"""The lines of a review about interfaces that the build file does not build."""

from __future__ import annotations

import pytest

from linkwright.review.changes import Location
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

CMAKE = """cmake_minimum_required(VERSION 3.8)
project(arm_msgs)
find_package(rosidl_default_generators REQUIRED)
{}
rosidl_generate_interfaces(${{PROJECT_NAME}} msg/State.msg {})
"""
FILES = {
    "arm_msgs/package.xml": PACKAGE_XML.replace("arm_description", "arm_msgs"),
    "arm_msgs/msg/State.msg": "bool on\n",
}
PATH = "arm_msgs/srv/Move.srv"
CMAKE_PATH = "arm_msgs/CMakeLists.txt"


@pytest.mark.parametrize(
    ("old", "is_breaking"),
    [
        (CMAKE.format("", ""), False),
        (CMAKE.format("# srv/Move.srv", ""), False),
        (CMAKE.format("", "srv/Move.srv"), True),
        (CMAKE.format("file(GLOB services srv/*.srv)", "${services}"), True),
        (CMAKE.format('file(GLOB_RECURSE found RELATIVE ${DIR} "srv/M*")', ""), True),
        (CMAKE.format("file(GLOB found ${PATTERN})", ""), True),
        (CMAKE.format("file(GLOB launch_files launch/*.py)", ""), False),
        (CMAKE.format("my_services(Move)", ""), True),
        (CMAKE.replace("rosidl_generate_interfaces", "my_interfaces").format("", ""), True),
        (CMAKE.format("add_service_files()", ""), True),
    ],
)
def test_interface_that_was_never_built_is_used_by_nobody(repository, compare, old, is_breaking):
    repository.commit({**FILES, CMAKE_PATH: old, PATH: "float64 x\n---\n"})
    repository.write({CMAKE_PATH: CMAKE.format("", "srv/Move.srv"), PATH: "float64 y\n---\n"})
    result = compare(repository)
    fields = ["field 'request x' renamed to 'request y'"]
    assert sentences(subject(result, PATH)) == fields
    assert [text for text in breaking(result) if text in fields] == (fields if is_breaking else [])


@pytest.mark.parametrize(
    ("listed", "expected"),
    [
        ("", "interface added: request: float64 x; CMakeLists.txt does not build it"),
        ("srv/Move.srv", "interface added: request: float64 x"),
    ],
)
def test_added_interface_that_is_not_built_is_named(repository, compare, listed, expected):
    repository.commit({**FILES, CMAKE_PATH: CMAKE.format("", "")})
    repository.write({CMAKE_PATH: CMAKE.format("", listed), PATH: "float64 x\n---\n"})
    assert sentences(subject(compare(repository), PATH)) == [expected]


@pytest.mark.parametrize("listed", ["", "srv/Move.srv"])
def test_added_interface_that_cannot_be_read_breaks_the_build_if_it_is_built(repository, compare, listed):
    repository.commit({**FILES, CMAKE_PATH: CMAKE.format("", "")})
    repository.write({CMAKE_PATH: CMAKE.format("", listed), PATH: "float64 x\n---\narm_msgs/State\n"})
    (added, fault) = subject(compare(repository), PATH).changes
    assert str(added.sentence) == "interface added"
    assert str(fault.sentence).startswith("the definition cannot be read: 'arm_msgs/State' is neither a field")
    assert (str(fault.reason), fault.location) == (
        ("the package does not build", Location(PATH, 3, 1)) if listed else ("None", None)
    )


@pytest.mark.parametrize(
    ("command", "is_built"),
    [
        ('message(STATUS "arm")\ninclude(GNUInstallDirs)\nament_export_interfaces(arm)', False),
        ("generate_messages(DEPENDENCIES std_msgs)", False),
        ("add_message_files()\ngenerate_messages(DEPENDENCIES std_msgs)", True),
        ("include(ArmTypes)", True),
        ("# rosidl_generate_interfaces(${PROJECT_NAME} srv/Move.srv)", False),
        ("my_generate_interfaces()", True),
        ("include(cmake/types.cmake)", True),
        ("include_directories(include)", False),
    ],
)
def test_build_file_without_any_interface_builds_none(repository, compare, command, is_built):
    repository.commit({"arm_msgs/package.xml": FILES["arm_msgs/package.xml"], CMAKE_PATH: "project(arm_msgs)\n"})
    package = "find_package(rosidl_default_generators REQUIRED)"
    repository.write({CMAKE_PATH: f"project(arm_msgs)\n{package}\n{command}\n", PATH: "float64 x\n---\n"})
    note = "" if is_built else "; CMakeLists.txt does not build it"
    assert sentences(subject(compare(repository), PATH)) == [f"interface added: request: float64 x{note}"]


@pytest.mark.parametrize(
    ("listed", "expected", "is_breaking"),
    [
        ("", "interface removed: request: float64 x; CMakeLists.txt did not build it", False),
        ("srv/Move.srv", "interface removed: request: float64 x", True),
    ],
)
def test_removed_interface_that_was_never_built_breaks_nothing(repository, compare, listed, expected, is_breaking):
    repository.commit({**FILES, CMAKE_PATH: CMAKE.format("", listed), PATH: "float64 x\n---\n"})
    repository.git("rm", "-q", PATH)
    repository.write({CMAKE_PATH: CMAKE.format("", "")})
    result = compare(repository)
    assert sentences(subject(result, PATH)) == [expected]
    assert breaking(result) == ([expected] if is_breaking else [])


def test_interface_that_a_build_file_of_a_subfolder_may_build_is_in_use(repository, compare):
    files = {CMAKE_PATH: "project(arm_msgs)\nadd_subdirectory(srv)\n", "arm_msgs/srv/CMakeLists.txt": "my_services()\n"}
    repository.commit({**FILES, **files, PATH: "float64 x\n---\n"})
    repository.write({PATH: "float64 y\n---\n"})
    assert breaking(compare(repository)) == ["field 'request x' renamed to 'request y'"]


@pytest.mark.parametrize(
    ("files", "is_breaking"),
    [
        ({}, False),
        ({"setup.py": "generate_types()\n"}, True),
        ({"setup.py": ""}, True),
        ({"arm_msgs/types.py": "TYPES = load('srv/Move.srv')\n"}, True),
        ({"srv/CMakeLists.txt": "project(services)\n"}, True),
    ],
)
def test_package_of_python_builds_no_interfaces(repository, compare, files, is_breaking):
    manifest = PACKAGE_XML.replace("arm_description", "arm_msgs").replace("ament_cmake", "ament_python")
    files = {"package.xml": manifest, "setup.py": "from setuptools import setup\nsetup(name='arm_msgs')\n", **files}
    repository.commit({**{f"arm_msgs/{path}": text for path, text in files.items()}, PATH: "float64 x\n---\n"})
    repository.write({PATH: "float64 y\n---\n"})
    fields = ["field 'request x' renamed to 'request y'"]
    assert breaking(compare(repository)) == (fields if is_breaking else [])


@pytest.mark.parametrize("listed", ["", "srv/Move.srv"])
def test_use_of_an_interface_that_was_never_built_did_not_work_before(repository, compare, listed):
    user = {"arm/node.py": "from arm_msgs.srv import Move\n"}
    repository.commit({**FILES, **user, CMAKE_PATH: CMAKE.format("", listed), PATH: "float64 x\n---\n"})
    repository.git("rm", "-q", PATH)
    repository.write({CMAKE_PATH: CMAKE.format("", "")})
    expected = ["uses the interface 'arm_msgs/Move', which no longer exists", "interface removed: request: float64 x"]
    assert breaking(compare(repository)) == (expected if listed else [])


@pytest.mark.parametrize("listed", ["", "srv/Move.srv"])
def test_interface_that_can_no_longer_be_read_fails_only_if_it_is_built(repository, compare, listed):
    repository.commit({**FILES, CMAKE_PATH: CMAKE.format("", ""), PATH: "float64 x\n---\n"})
    repository.write({CMAKE_PATH: CMAKE.format("", listed), PATH: "float64 x\n---\narm_msgs/State\n"})
    assert [text[:23] for text in breaking(compare(repository))] == (["can no longer be read: "] if listed else [])


def test_removed_interface_of_a_package_without_build_file_is_told_with_it(repository, compare):
    manifest = PACKAGE_XML.replace("arm_description", "arm_msgs").replace("ament_cmake", "ament_python")
    setup = "from setuptools import setup\nsetup(name='arm_msgs')\n"
    repository.commit({"arm_msgs/package.xml": manifest, "arm_msgs/setup.py": setup, PATH: "float64 x\n---\n"})
    repository.git("rm", "-q", PATH)
    assert sentences(subject(compare(repository), PATH)) == [
        "interface removed: request: float64 x; the package has no CMakeLists.txt"
    ]
