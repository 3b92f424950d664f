"""Libraries, classes and members that no other package can use are not breaking in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {
    "a/package.xml": PACKAGE_XML.replace(
        "  <exec_depend>", "  <buildtool_depend>catkin</buildtool_depend>\n  <exec_depend>"
    ),
    "a/src/core.cpp": "int limit() { return 3; }\n",
}
BUILD = """project(a)
find_package(catkin REQUIRED)
catkin_package({})
add_library({} src/core.cpp)
add_executable(node src/node.cpp)
target_link_libraries(node {})
"""


@pytest.mark.parametrize(
    ("arguments", "source", "is_breaking"),
    [
        ("", "", False),
        ("INCLUDE_DIRS include", "", False),
        ("LIBRARIES core", "", True),
        ("LIBRARIES ${ALL_LIBRARIES}", "", True),
        ("", "PLUGINLIB_EXPORT_CLASS(a::Core, a::Base)\n", True),
        ("", 'extern "C" int get_limit() { return limit(); }\n', True),
    ],
)
def test_library_that_only_its_package_links_is_private(repository, compare, arguments, source, is_breaking):
    files = {"a/src/core.cpp": MANIFEST["a/src/core.cpp"] + source}
    repository.commit({**MANIFEST, **files, "a/CMakeLists.txt": BUILD.format(arguments, "core", "core")})
    repository.write({"a/CMakeLists.txt": BUILD.format(arguments, "limits", "limits")})
    result = compare(repository)
    found = [line for subject in result.subjects for line in sentences(subject)]
    assert "built libraries: 'core' renamed to 'limits'" in found
    assert ("built libraries: 'core' renamed to 'limits'" in breaking(result)) == is_breaking


@pytest.mark.parametrize(
    ("target", "body", "is_breaking"),
    [("add_executable(node", ";", False), ("add_library(core", ";", True), ("add_executable(node", "{}", True)],
)
def test_class_whose_code_is_only_in_programs_is_private(repository, compare, target, body, is_breaking):
    build = "project(a)\nfind_package(catkin REQUIRED)\ncatkin_package(INCLUDE_DIRS include)\n" + target
    header = f"#pragma once\nnamespace a {{\nclass Path {{\npublic:\n  void smooth(){body}\n  double step_;\n}};\n}}\n"
    repository.commit({**MANIFEST, "a/CMakeLists.txt": f"{build} src/core.cpp)\n", "a/include/a/path.h": header})
    repository.write({"a/include/a/path.h": "#pragma once\n"})
    assert ("classes removed: 'Path'" in breaking(compare(repository))) == is_breaking
    repository.write({"a/include/a/path.h": header.replace("  double step_;\n", "")})
    assert ("public members removed: 'Path::step_' (double)" in breaking(compare(repository))) == is_breaking


@pytest.mark.parametrize(
    ("manifest", "field"), [(MANIFEST["a/package.xml"], "time"), (PACKAGE_XML, "builtin_interfaces/Time")]
)
def test_added_interface_has_the_types_of_its_ros_version(repository, compare, manifest, field):
    repository.commit({"a/package.xml": manifest})
    repository.write({"a/msg/State.msg": f"{field} stamp\n"})
    (subject,) = compare(repository).subjects
    assert sentences(subject) == [f"interface added: {field} stamp"]


NODE = "#include <ros/ros.h>\nvoid Arm::run() {{\n  pub_ = {};\n}}\n"


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        ('create_publisher<std_msgs::msg::Bool>("state", 10)', []),
        ('create_publisher<std_msgs::msg::Bool>("state", 1)', ["publisher 'state': queue 10 -> 1"]),
    ],
)
def test_depth_of_ros2_is_the_queue_of_ros1(repository, compare, new, expected):
    old = NODE.format('nh_.advertise<std_msgs::Bool>("state", 10)')
    repository.commit({**MANIFEST, "a/src/node.cpp": old})
    repository.write({"a/src/node.cpp": NODE.format(new)})
    found = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert [line for line in found if "queue" in line] == expected
