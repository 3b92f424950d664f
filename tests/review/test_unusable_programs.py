"""Added scripts that ROS does not find, although it finds the other scripts of their folder."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

SCRIPT = "#!/usr/bin/env python3\nprint('arm')\n"
NODE = SCRIPT + "if __name__ == '__main__':\n    rclpy.init()\n    rclpy.spin(Arm())\n"
BUILD = "cmake_minimum_required(VERSION 3.8)\nproject(arm)\ninstall(PROGRAMS {} DESTINATION lib/${{PROJECT_NAME}})\n"
MANIFEST = PACKAGE_XML.replace("arm_description", "arm")
CATKIN = MANIFEST.replace("<exec_depend>", "<buildtool_depend>catkin</buildtool_depend><exec_depend>")
NOT_INSTALLED = "no build file installs the program, so that ros2 run does not find it"
NOT_EXECUTABLE = "the program is not executable, so that rosrun does not find it"


def list_lines(repository, compare, files: dict[str, str]) -> list[str]:
    repository.write(files)
    return [line for found in compare(repository).subjects for line in sentences(found)]


@pytest.mark.parametrize(
    ("old", "new", "is_told"),
    [
        ("scripts/a.py", "scripts/a.py", True),
        ("scripts/a.py", "scripts/a.py scripts/bend.py", False),
        ("nodes/c.py", "nodes/c.py", False),
    ],
)
def test_script_that_no_build_file_installs(repository, compare, old, new, is_told):
    files = {"arm/scripts/a.py": SCRIPT, "arm/nodes/c.py": SCRIPT, "arm/CMakeLists.txt": BUILD.format(old)}
    repository.commit({"arm/package.xml": MANIFEST, **files})
    lines = list_lines(repository, compare, {"arm/scripts/bend.py": SCRIPT, "arm/CMakeLists.txt": BUILD.format(new)})
    assert (NOT_INSTALLED in lines) is is_told


@pytest.mark.parametrize(("is_executable", "is_told"), [(True, True), (False, False)])
def test_script_of_ros1_that_is_not_executable(repository, compare, is_executable, is_told):
    build = "project(arm)\nfind_package(catkin REQUIRED)\ncatkin_package()\n"
    repository.write({"arm/package.xml": CATKIN, "arm/scripts/a.py": SCRIPT, "arm/CMakeLists.txt": build})
    repository.root.joinpath("arm/scripts/a.py").chmod(0o755 if is_executable else 0o644)
    repository.commit({})
    assert (NOT_EXECUTABLE in list_lines(repository, compare, {"arm/scripts/bend.py": SCRIPT})) is is_told


@pytest.mark.parametrize(
    ("text", "is_executable", "files", "is_told"),
    [
        (NODE, True, {}, True),
        (NODE, False, {}, False),
        (SCRIPT, True, {}, False),
        (NODE, True, {"arm/scripts/__init__.py": ""}, False),
        (NODE, True, {"arm/CMakeLists.txt": BUILD.format("nodes/c.py scripts/bend.py")}, False),
    ],
)
def test_script_that_starts_a_node_and_is_not_installed(repository, compare, text, is_executable, files, is_told):
    build = BUILD.format("nodes/c.py")
    repository.commit({"arm/package.xml": MANIFEST, "arm/nodes/c.py": SCRIPT, "arm/CMakeLists.txt": build})
    repository.write({"arm/scripts/bend.py": text, **files})
    repository.root.joinpath("arm/scripts/bend.py").chmod(0o755 if is_executable else 0o644)
    assert (NOT_INSTALLED in list_lines(repository, compare, {})) is is_told


@pytest.mark.parametrize("name", ["bend.py", "bend_fast.py"])
def test_script_that_is_not_installed_although_a_launch_file_passes_its_name_to_another_one_is_breaking(
    repository, compare, name
):
    files = {"arm/scripts/a.py": SCRIPT, "arm/CMakeLists.txt": BUILD.format("scripts/a.py")}
    launch = '<launch>\n  <include file="arm.launch.xml"><arg name="program" value="{}"/></include>\n</launch>\n'
    repository.commit({"arm/package.xml": MANIFEST, **files})
    repository.write({"arm/scripts/bend.py": SCRIPT, "arm/launch/bend.launch.xml": launch.format(name)})
    line = f"{NOT_INSTALLED}; arm/launch/bend.launch.xml starts it"
    assert (line in breaking(compare(repository))) is (name == "bend.py")
