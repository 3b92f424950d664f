"""What a package installs, as read from its CMakeLists.txt."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.diagnostics import SourceText
from linkwright.packages.readers.cmake import CMakeFile, read_cmake

HEAD = "cmake_minimum_required(VERSION 3.8)\nproject(arm)\nfind_package(ament_cmake REQUIRED)\n"


def rules(text: str, package: Path | None = None) -> CMakeFile:
    return read_cmake(SourceText("CMakeLists.txt", HEAD + text + "\nament_package()\n"), package)


def copied(text: str, package: Path) -> dict[str, str]:
    """Source -> destination of all files that are copied; nothing else may be left open."""
    found = rules(text, package)
    assert found.is_complete, found.unknown
    return {file.source: file.destination for file in found.installed(package)}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    for name in ("urdf/arm.urdf", "urdf/parts/hand.xacro", "urdf/notes.txt", "launch/show.launch.py", "scripts/run.py"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")
    return tmp_path


def test_folders_are_copied_with_their_name(package: Path) -> None:
    assert copied("install(DIRECTORY urdf launch DESTINATION share/${PROJECT_NAME})", package) == {
        "urdf/arm.urdf": "share/arm/urdf/arm.urdf",
        "urdf/notes.txt": "share/arm/urdf/notes.txt",
        "urdf/parts/hand.xacro": "share/arm/urdf/parts/hand.xacro",
        "launch/show.launch.py": "share/arm/launch/show.launch.py",
    }


def test_a_slash_means_the_content(package: Path) -> None:
    found = copied('install(DIRECTORY "launch/" DESTINATION share/arm/start)', package)
    assert found == {"launch/show.launch.py": "share/arm/start/show.launch.py"}


def test_patterns(package: Path) -> None:
    only = 'install(DIRECTORY urdf DESTINATION share/arm FILES_MATCHING PATTERN "*.urdf" PATTERN "*.xacro")'
    assert set(copied(only, package)) == {"urdf/arm.urdf", "urdf/parts/hand.xacro"}
    without = 'install(DIRECTORY urdf DESTINATION share/arm PATTERN "parts" EXCLUDE)'
    assert set(copied(without, package)) == {"urdf/arm.urdf", "urdf/notes.txt"}


def test_programs_and_a_new_name(package: Path) -> None:
    text = (
        "install(PROGRAMS scripts/run.py DESTINATION lib/${PROJECT_NAME})\n"
        "install(FILES urdf/arm.urdf DESTINATION share/${PROJECT_NAME} RENAME robot.urdf)"
    )
    assert copied(text, package) == {"scripts/run.py": "lib/arm/run.py", "urdf/arm.urdf": "share/arm/robot.urdf"}
    assert rules(text).programs == {"run.py": "scripts/run.py"}


def test_interfaces_and_python_modules() -> None:
    found = rules(
        'set(messages "msg/A.msg" msg/C.msg)\n'
        'rosidl_generate_interfaces(${PROJECT_NAME} ${messages} "srv/B.srv" DEPENDENCIES std_msgs)\n'
        "ament_python_install_package(${PROJECT_NAME})"
    )
    assert found.interfaces == ["msg/A.msg", "msg/C.msg", "srv/B.srv"]
    assert found.modules == ["arm"]


def test_auto_package_installs_to_share(package: Path) -> None:
    found = read_cmake(SourceText("CMakeLists.txt", "project(arm)\nament_auto_package(INSTALL_TO_SHARE launch)\n"))
    assert [file.destination for file in found.installed(package)] == ["share/arm/launch/show.launch.py"]


@pytest.mark.parametrize(
    "text",
    [
        "foreach(name urdf launch)\n  install(DIRECTORY ${name} DESTINATION share/arm)\nendforeach()",
        (
            "set(all urdf)\nlist(APPEND all launch)\nforeach(name IN LISTS all)\n"
            "  install(DIRECTORY ${name} DESTINATION ${CMAKE_INSTALL_DATADIR}/arm)\nendforeach()"
        ),
        (
            "function(share)\n  install(DIRECTORY ${ARGN} DESTINATION share/${PROJECT_NAME})\nendfunction()\n"
            "share(urdf launch)"
        ),
        (
            "macro(share folder)\n  install(DIRECTORY ${folder} DESTINATION share/arm)\nendmacro()\n"
            "share(urdf)\nshare(launch)"
        ),
        (
            'function(share)\n  cmake_parse_arguments(GIVEN "" "INTO" "FOLDERS" ${ARGN})\n'
            "  install(DIRECTORY ${GIVEN_FOLDERS} DESTINATION share/${GIVEN_INTO})\nendfunction()\n"
            "share(FOLDERS urdf launch INTO arm)"
        ),
        (
            "if(BUILD_ALL)\n  install(DIRECTORY urdf DESTINATION share/arm)\nendif()\n"
            "install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/launch DESTINATION ${CMAKE_INSTALL_PREFIX}/share/arm)"
        ),
    ],
)
def test_loops_functions_and_variables_are_followed(package: Path, text: str) -> None:
    assert copied(text, package) == copied("install(DIRECTORY urdf launch DESTINATION share/arm)", package)


def test_patterns_of_files_are_expanded(package: Path) -> None:
    text = 'file(GLOB_RECURSE found "urdf/*.xacro")\ninstall(FILES ${found} DESTINATION share/arm/xacro)'
    assert copied(text, package) == {"urdf/parts/hand.xacro": "share/arm/xacro/hand.xacro"}
    text = "file(GLOB found RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} urdf/*.urdf)\ninstall(FILES ${found} DESTINATION x)"
    assert copied(text, package) == {"urdf/arm.urdf": "x/arm.urdf"}


def test_subdirectories_and_included_files(package: Path) -> None:
    (package / "urdf" / "CMakeLists.txt").write_text(
        "install(FILES arm.urdf DESTINATION share/${PROJECT_NAME}/robots)\n"
        "install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/parts DESTINATION share/${PROJECT_NAME})\n"
    )
    (package / "more.cmake").write_text("install(FILES launch/show.launch.py DESTINATION share/arm)\n")
    text = "include(GNUInstallDirs)\ninclude(more.cmake)\nadd_subdirectory(urdf)"
    assert copied(text, package) == {
        "launch/show.launch.py": "share/arm/show.launch.py",
        "urdf/arm.urdf": "share/arm/robots/arm.urdf",
        "urdf/parts/hand.xacro": "share/arm/parts/hand.xacro",
    }
    found = rules(text, package)
    assert found.span(found.files[1]).file == str(package / "urdf" / "CMakeLists.txt")


def test_files_that_are_configured(package: Path) -> None:
    (package / "limits.yaml.in").write_text("@PROJECT_NAME@: ${SPEED}@MISSING@\n")
    found = rules(
        "set(SPEED 2)\nconfigure_file(limits.yaml.in ${CMAKE_CURRENT_BINARY_DIR}/limits.yaml)\n"
        "install(FILES ${CMAKE_CURRENT_BINARY_DIR}/limits.yaml DESTINATION share/arm)",
        package,
    )
    (file,) = found.installed(package)
    assert (file.source, file.destination) == ("limits.yaml.in", "share/arm/limits.yaml")
    assert file.text(package) == "arm: 2\n"


def test_what_is_compiled_is_told_and_the_rest_is_read(package: Path) -> None:
    text = "add_executable(move src/move.cpp)\nadd_library(kinematics SHARED k.cpp)\nadd_library(headers INTERFACE)\n"
    found = rules(text + "install(DIRECTORY launch DESTINATION share/arm)", package)
    assert found.compiled == ["move", "kinematics"]
    assert found.executables == {"move"}
    assert [file.source for file in found.installed(package)] == ["launch/show.launch.py"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("foreach(name ${SOMETHING})\n  install(DIRECTORY ${name} DESTINATION share/arm)\nendforeach()", "foreach()"),
        ("install(DIRECTORY urdf DESTINATION ${SOMEWHERE})", "cannot be read without CMake"),
        ("if(A)\nset(x urdf)\nelse()\nset(x launch)\nendif()\ninstall(DIRECTORY ${x} DESTINATION y)", "without CMake"),
        ("add_subdirectory(none)", "add_subdirectory()"),
        ("function(again)\n  again()\nendfunction()\nagain()", "function()"),
        ("foreach(a 1 2 3 4 5 6 7 8 9)\n" * 9 + "message(x)\n" + "endforeach()\n" * 9, "message()"),
    ],
)
def test_what_is_not_known_is_told(package: Path, text: str, said: str) -> None:
    assert any(said in reason for reason in rules(text, package).unknown)


def test_what_is_not_there_is_named(package: Path) -> None:
    with pytest.raises(FileNotFoundError, match="meshes"):
        list(rules("install(DIRECTORY meshes DESTINATION share/arm)").installed(package))
    for text in ("install(FILES none DESTINATION x OPTIONAL)", "if(A)\ninstall(FILES none DESTINATION x)\nendif()"):
        assert copied(text, package) == {}
