"""The lines of a review about parameter files that nobody misses: clocks, renamed lists, placeholders and tests."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

NAVIGATION = """local_client:
  ros__parameters:
    use_sim_time: true
behavior_server:
  ros__parameters:
    recovery_plugins: [spin, wait]
    spin: {plugin: nav2/Spin}
    enabled: true
"""
PATH = "arm/config/navigation.yaml"


def review_text(repository, compare, new: str, files: dict[str, str] | None = None):
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: NAVIGATION, **(files or {})})
    repository.write({PATH: new})
    return compare(repository)


CLOCK = NAVIGATION[: NAVIGATION.index("behavior_server")]


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        (CLOCK, "", False),
        (NAVIGATION[NAVIGATION.index("behavior_server") :], "", True),
        ("recovery_plugins: [spin, wait]", "behavior_plugins: [spin, wait, drive]", False),
        ("recovery_plugins: [spin, wait]", "behavior_plugins: [spin]", True),
        ("recovery_plugins: [spin, wait]", "recovery_plugins: [spin]\n    other_plugins: [wait]", False),
        ("enabled: true", "enabled: 'on'", True),
    ],
)
def test_only_what_somebody_misses_is_breaking(repository, compare, old, new, is_breaking):
    assert old in NAVIGATION
    result = review_text(repository, compare, NAVIGATION.replace(old, new))
    assert sentences(subject(result, PATH))
    assert bool(breaking(result)) is is_breaking


@pytest.mark.parametrize(("text", "is_breaking"), [("'KEEPOUT'", False), ("'OTHER'", True)])
def test_placeholder_that_a_launch_file_replaces_has_no_type(repository, compare, text, is_breaking):
    launch = f"def generate_launch_description():\n    return RewrittenYaml('x', value_rewrites={{{text}: keepout}})\n"
    new = NAVIGATION.replace("enabled: true", "enabled: KEEPOUT")
    result = review_text(repository, compare, new, {"arm/launch/navigation.launch.py": launch})
    assert bool(breaking(result)) is is_breaking


CONTROLLERS = """controller_manager:
  ros__parameters:
    arm_controller:
      type: joint_trajectory_controller/JointTrajectoryController
"""


@pytest.mark.parametrize(("key", "is_lost"), [("/**/controller_manager", False), ("ns/controller_manager", False)])
def test_controller_manager_in_any_namespace_has_the_controllers(repository, compare, key, is_lost):
    launch = '<launch><node pkg="controller_manager" exec="spawner" args="arm_controller"/></launch>'
    files = {"arm/package.xml": PACKAGE_XML, "arm/launch/arm.launch.xml": launch}
    repository.commit({**files, "arm/config/controllers.yaml": CONTROLLERS})
    repository.write({"arm/config/controllers.yaml": CONTROLLERS.replace("controller_manager", key)})
    result = compare(repository)
    assert any("names the controller" in text for text in breaking(result)) is is_lost


CMAKE = """cmake_minimum_required(VERSION 3.8)
project(arm)
if(BUILD_TESTING)
  install(DIRECTORY test/config DESTINATION share/${PROJECT_NAME}/test)
endif()
"""


@pytest.mark.parametrize("is_removed", [True, False])
@pytest.mark.parametrize(
    ("cmake", "is_breaking"),
    [(CMAKE, False), (CMAKE.replace("if(BUILD_TESTING)", "").replace("endif()", ""), True)],
)
def test_files_that_only_tests_use_are_not_breaking(repository, compare, cmake, is_breaking, is_removed):
    path = "arm/test/config/navigation.yaml"
    package = PACKAGE_XML.replace("arm_description", "arm")
    repository.commit({"arm/package.xml": package, "arm/CMakeLists.txt": cmake, path: NAVIGATION})
    repository.write({path: None if is_removed else CLOCK})
    result = compare(repository)
    assert sentences(subject(result, path))
    assert any(found.path == path for found, _ in result.breaking_changes) is is_breaking


@pytest.mark.parametrize("install", ["", "install(DIRECTORY test DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})\n"])
def test_launch_files_of_tests_are_not_breaking_in_ros_1_either(repository, compare, install):
    path = "arm/test/arm.launch"
    package = PACKAGE_XML.replace("arm_description", "arm").replace(
        "<exec", "<buildtool_depend>catkin</buildtool_depend><exec", 1
    )
    cmake = f"cmake_minimum_required(VERSION 3.0)\nproject(arm)\nfind_package(catkin)\ncatkin_package()\n{install}"
    launch = '<launch><node pkg="amcl" type="amcl" name="amcl"/></launch>\n'
    repository.commit({"arm/package.xml": package, "arm/CMakeLists.txt": cmake, path: launch})
    repository.write({path: "<launch/>\n"})
    assert bool(breaking(compare(repository))) is bool(install)
