"""What an ``ament_cmake`` package installs, as read from its CMakeLists.txt."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.diagnostics import SourceText
from linkwright.shell.install_rules import InstallRules, read_install_rules

HEAD = "cmake_minimum_required(VERSION 3.8)\nproject(arm)\nfind_package(ament_cmake REQUIRED)\n"


def rules(text: str) -> InstallRules:
    return read_install_rules(SourceText("CMakeLists.txt", HEAD + text + "\nament_package()\n"), "arm")


@pytest.fixture
def package(tmp_path: Path) -> Path:
    for name in ("urdf/arm.urdf", "urdf/parts/hand.xacro", "urdf/notes.txt", "launch/show.launch.py", "scripts/run.py"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")
    return tmp_path


def test_folders_are_copied_with_their_name(package: Path) -> None:
    found = rules("install(DIRECTORY urdf launch DESTINATION share/${PROJECT_NAME})")
    assert found.obstacle is None
    assert dict(found.files(package)) == {
        "urdf/arm.urdf": "share/arm/urdf/arm.urdf",
        "urdf/notes.txt": "share/arm/urdf/notes.txt",
        "urdf/parts/hand.xacro": "share/arm/urdf/parts/hand.xacro",
        "launch/show.launch.py": "share/arm/launch/show.launch.py",
    }


def test_a_slash_means_the_content(package: Path) -> None:
    found = rules('install(DIRECTORY "launch/" DESTINATION share/arm/start)')
    assert dict(found.files(package)) == {"launch/show.launch.py": "share/arm/start/show.launch.py"}


def test_patterns(package: Path) -> None:
    only = rules('install(DIRECTORY urdf DESTINATION share/arm FILES_MATCHING PATTERN "*.urdf" PATTERN "*.xacro")')
    assert sorted(source for source, _ in only.files(package)) == ["urdf/arm.urdf", "urdf/parts/hand.xacro"]
    without = rules('install(DIRECTORY urdf DESTINATION share/arm PATTERN "parts" EXCLUDE)')
    assert sorted(source for source, _ in without.files(package)) == ["urdf/arm.urdf", "urdf/notes.txt"]


def test_programs_and_a_new_name(package: Path) -> None:
    found = rules(
        "install(PROGRAMS scripts/run.py DESTINATION lib/${PROJECT_NAME})\n"
        "install(FILES urdf/arm.urdf DESTINATION share/${PROJECT_NAME} RENAME robot.urdf)"
    )
    assert dict(found.files(package)) == {
        "scripts/run.py": "lib/arm/run.py",
        "urdf/arm.urdf": "share/arm/robot.urdf",
    }


def test_interfaces_and_python_modules() -> None:
    found = rules(
        'set(messages "msg/A.msg")\n'
        'rosidl_generate_interfaces(${PROJECT_NAME} ${messages} "srv/B.srv" DEPENDENCIES std_msgs)\n'
        "ament_python_install_package(${PROJECT_NAME})"
    )
    assert found.interfaces == ("msg/A.msg", "srv/B.srv")
    assert found.modules == ("arm",)


def test_auto_package_installs_to_share(package: Path) -> None:
    text = "project(arm)\nament_auto_package(INSTALL_TO_SHARE launch)\n"
    found = read_install_rules(SourceText("CMakeLists.txt", text), "arm")
    assert dict(found.files(package)) == {"launch/show.launch.py": "share/arm/launch/show.launch.py"}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("add_executable(move src/move.cpp)", "compiles 'move'"),
        ("add_library(kinematics SHARED src/k.cpp)", "compiles 'kinematics'"),
        ("foreach(name a b)\n  install(DIRECTORY ${name} DESTINATION share/arm)\nendforeach()", "foreach()"),
        ("install(DIRECTORY urdf DESTINATION ${SOMEWHERE})", "cannot be read without CMake"),
    ],
)
def test_what_cannot_be_copied_is_told(text: str, said: str) -> None:
    assert said in (rules(text).obstacle or "")


def test_an_interface_library_compiles_nothing() -> None:
    assert rules("add_library(headers INTERFACE)").obstacle is None


def test_what_is_not_there_is_named(package: Path) -> None:
    found = rules("install(DIRECTORY meshes DESTINATION share/arm)")
    with pytest.raises(FileNotFoundError, match="meshes"):
        list(found.files(package))
