"""The lines of a review about launch files that start programs which do not exist."""

from __future__ import annotations

import os

import pytest

from tests.repositories import Repository
from tests.review.conftest import breaking

MANIFEST = "<package><name>{name}</name><version>1.0.0</version><buildtool_depend>{tool}</buildtool_depend></package>\n"
CMAKE = "cmake_minimum_required(VERSION 3.8)\nproject(lamp)\nfind_package({tool} REQUIRED)\n{body}"
SCRIPTS = "install(PROGRAMS scripts/old.py scripts/other.py DESTINATION lib/lamp)\n"
LAUNCHES = {
    "a.launch": '<launch><node pkg="lamp" type="{name}" name="n"/></launch>\n',
    "a.launch.xml": '<launch><node pkg="lamp" exec="{name}" name="n"/></launch>\n',
    "a.launch.yaml": "launch:\n- node:\n    pkg: lamp\n    exec: {name}\n",
    "a.launch.py": "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
    "def generate_launch_description():\n    return LaunchDescription([Node(package='lamp', executable='{name}')])\n",
}


def write_package(repository: Repository, tool: str, body: str, launch: str, name: str, folder: str = "lamp"):
    files = {
        "lamp/package.xml": MANIFEST.format(name="lamp", tool=tool),
        "start/package.xml": MANIFEST.format(name="start", tool=tool),
        "lamp/CMakeLists.txt": CMAKE.format(tool=tool, body=body),
        "lamp/scripts/old.py": "#!/usr/bin/env python3\nprint(1)\n",
        "lamp/scripts/other.py": "#!/usr/bin/env python3\nprint(2)\n",
        f"{folder}/launch/{launch}": LAUNCHES[launch].format(name=name),
    }
    repository.commit(files)


@pytest.mark.parametrize("folder", ["lamp", "start"])
@pytest.mark.parametrize("launch", LAUNCHES)
def test_a_launch_file_that_starts_a_removed_script_is_named(repository, compare, launch, folder):
    tool = "catkin" if launch == "a.launch" else "ament_cmake"
    write_package(repository, tool, SCRIPTS, launch, "old.py", folder)
    repository.write({"lamp/CMakeLists.txt": CMAKE.format(tool=tool, body=SCRIPTS.replace("scripts/old.py ", ""))})
    (repository.root / "lamp/scripts/old.py").unlink()
    result = compare(repository)
    assert "starts 'lamp/old.py', which no longer exists" in breaking(result)
    assert "LW844" not in [finding.code for finding in result.new_findings]


def test_a_launch_file_that_starts_a_script_which_is_no_longer_installed_is_named(repository, compare):
    write_package(repository, "ament_cmake", SCRIPTS, "a.launch.py", "old.py")
    body = SCRIPTS.replace("scripts/old.py ", "")
    repository.write({"lamp/CMakeLists.txt": CMAKE.format(tool="ament_cmake", body=body)})
    assert "starts 'lamp/old.py', which is no longer installed" in breaking(compare(repository))


def test_a_package_below_another_one_of_its_name_hides_no_program(repository, compare):
    write_package(repository, "ament_cmake", SCRIPTS, "a.launch.py", "old.py")
    repository.commit({"lamp/simulation/package.xml": MANIFEST.format(name="lamp", tool="ament_cmake")})
    body = SCRIPTS.replace("scripts/old.py ", "")
    repository.write({"lamp/CMakeLists.txt": CMAKE.format(tool="ament_cmake", body=body)})
    assert "starts 'lamp/old.py', which is no longer installed" in breaking(compare(repository))


def test_a_script_in_the_sources_of_a_catkin_package_is_found(repository, compare):
    write_package(repository, "catkin", SCRIPTS, "a.launch", "old.py")
    repository.write({"lamp/CMakeLists.txt": CMAKE.format(tool="catkin", body="")})
    assert not [line for line in breaking(compare(repository)) if line.startswith("starts")]


@pytest.mark.parametrize("text", ["", "set(NAMES old other)\nforeach(name ${NAMES})\nendforeach()\n"])
def test_a_launch_file_that_starts_a_removed_executable_is_named(repository, compare, text):
    body = "add_executable(old old.cpp)\ninstall(TARGETS old DESTINATION lib/lamp)\n"
    write_package(repository, "ament_cmake", body, "a.launch.xml", "old")
    repository.write({"lamp/CMakeLists.txt": CMAKE.format(tool="ament_cmake", body=text)})
    found = [line for line in breaking(compare(repository)) if line.startswith("starts")]
    assert found == ([] if text else ["starts 'lamp/old', which no longer exists"])


@pytest.mark.parametrize("launch", LAUNCHES)
@pytest.mark.parametrize(
    ("body", "is_found"),
    [
        (SCRIPTS, True),
        (SCRIPTS + "configure_file(new.in scripts/new.py)\n", False),
        (SCRIPTS + "## Rename C++ executable without prefix\n# configure_file(new.in scripts/new.py)\n", True),
    ],
)
def test_a_changed_launch_file_that_starts_a_script_which_does_not_exist_is_named(
    repository, compare, launch, body, is_found
):
    write_package(repository, "catkin" if launch == "a.launch" else "ament_cmake", body, launch, "old.py")
    repository.write({f"lamp/launch/{launch}": LAUNCHES[launch].format(name="new.py")})
    found = [line for line in breaking(compare(repository)) if line.startswith("starts")]
    assert found == (["starts 'lamp/new.py', which does not exist"] if is_found else [])


@pytest.mark.skipif(os.name == "nt", reason="permissions of POSIX")
@pytest.mark.parametrize(
    ("launch", "body", "mode", "is_found"),
    [
        ("a.launch", "", 0o644, True),
        ("a.launch", "", 0o755, False),
        ("a.launch", "catkin_install_python(PROGRAMS scripts/other.py DESTINATION lib/lamp)\n", 0o644, False),
        ("a.launch.xml", SCRIPTS, 0o644, False),
    ],
)
def test_a_changed_launch_file_that_starts_a_script_which_is_not_executable_is_named(
    repository, compare, launch, body, mode, is_found
):
    write_package(repository, "catkin" if launch == "a.launch" else "ament_cmake", body, launch, "old.py")
    (repository.root / "lamp/scripts/other.py").chmod(mode)
    repository.write({f"lamp/launch/{launch}": LAUNCHES[launch].format(name="other.py")})
    found = [line for line in breaking(compare(repository)) if line.startswith("starts")]
    assert found == (["starts 'lamp/other.py', which is not executable"] if is_found else [])


EXECUTABLE = "add_executable(old old.cpp)\ninstall(TARGETS old DESTINATION lib/lamp)\n"


@pytest.mark.parametrize(
    ("body", "is_found"),
    [
        (EXECUTABLE, True),
        (EXECUTABLE + "add_executable(new new.cpp)\n", False),
        (EXECUTABLE + "foreach(age ne)\nadd_executable(${age}w ${age}w.cpp)\nendforeach()\n", False),
        ("set(prefix ne)\nadd_executable(${prefix}w new.cpp)\n", False),
        ("include(cmake/programs.cmake)\n", False),
    ],
)
def test_a_changed_launch_file_that_starts_an_executable_which_nothing_builds_is_named(
    repository, compare, body, is_found
):
    write_package(repository, "catkin", body, "a.launch", "old")
    repository.write({"lamp/launch/a.launch": LAUNCHES["a.launch"].format(name="new")})
    found = [line for line in breaking(compare(repository)) if line.startswith("starts")]
    assert found == (["starts 'lamp/new', which does not exist"] if is_found else [])


def rename_package(repository: Repository, launch: str, text: str):
    write_package(repository, "ament_cmake", SCRIPTS, launch, "old.py", "start")
    manifest = MANIFEST.format(name="beacon", tool="ament_cmake")
    body = CMAKE.format(tool="ament_cmake", body=SCRIPTS.replace("lib/lamp", "lib/beacon"))
    repository.write(
        {
            "lamp/package.xml": manifest,
            "lamp/CMakeLists.txt": body.replace("project(lamp)", "project(beacon)"),
            f"start/launch/{launch}": text,
        }
    )


OLD_NAME = "names the package 'lamp', whose name is 'beacon' now"


@pytest.mark.parametrize("launch", LAUNCHES)
@pytest.mark.parametrize(("package", "is_found"), [("lamp", True), ("beacon", False)])
def test_a_launch_file_that_names_a_renamed_package_is_named(repository, compare, launch, package, is_found):
    rename_package(repository, launch, LAUNCHES[launch].replace("lamp", package).format(name="old.py"))
    assert (OLD_NAME in breaking(compare(repository))) is is_found


def test_a_launch_file_that_includes_a_file_of_a_renamed_package_is_named(repository, compare):
    include = '<launch><include file="$(find-pkg-share lamp)/launch/lamp.launch.xml"/></launch>\n'
    rename_package(repository, "a.launch.xml", include)
    assert OLD_NAME in breaking(compare(repository))


def test_a_renamed_package_that_another_one_replaces_is_found(repository, compare):
    rename_package(repository, "a.launch.xml", LAUNCHES["a.launch.xml"].format(name="old.py"))
    repository.write({"other/package.xml": MANIFEST.format(name="lamp", tool="ament_cmake")})
    assert OLD_NAME not in breaking(compare(repository))


def test_a_launch_file_that_starts_a_program_which_its_renamed_package_has_lost_is_named(repository, compare):
    text = LAUNCHES["a.launch.xml"].replace("lamp", "beacon").format(name="old.py")
    rename_package(repository, "a.launch.xml", text)
    body = CMAKE.format(tool="ament_cmake", body=SCRIPTS.replace("scripts/old.py ", "").replace("lamp", "beacon"))
    repository.write({"lamp/CMakeLists.txt": body.replace("project(lamp)", "project(beacon)")})
    (repository.root / "lamp/scripts/old.py").unlink()
    assert "starts 'beacon/old.py', which no longer exists" in breaking(compare(repository))
