"""Executables of packages: in sources, in installations and built in."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from launch_ros.actions import Node
from launch_ros.substitutions import ExecutableInPackage

from launch import LaunchContext
from linkwright.diagnostics import LinkwrightError
from linkwright.launch import builtin_packages, find_executables
from linkwright.launch.errors.unavailable import is_unavailable
from linkwright.launch.ros.executables import Origin, find_executable
from linkwright.packages import PackageFinder, use_finder
from linkwright.packages.programs.interpreters import needs_our_interpreter
from linkwright.packages.programs.source_programs import EntryPoint, find_source_programs
from linkwright.packages.programs.workspace_environment import make_workspace_environment

Write = Callable[[str, str], Path]
SETUP = """
from setuptools import setup
name = 'arm'
setup(
    name=name,
    packages=[name],
    entry_points={'console_scripts': ['wave = arm.wave:main', 'nod=arm.nod:Nodder.run', f'shake = {name}.shake:main']},
)
"""


@pytest.fixture
def finder(tmp_path: Path) -> PackageFinder:
    return PackageFinder(start=tmp_path / "ws", environment={})


@pytest.fixture
def arm(write: Write) -> Path:
    """Write a source package with three entry points."""
    write("ws/src/arm/package.xml", "<package><name>arm</name></package>")
    write("ws/src/arm/setup.py", SETUP)
    write("ws/src/arm/arm/__init__.py", "")
    write(
        "ws/src/arm/arm/wave.py", "import sys\nimport hand\ndef main():\n    print(hand.NAME, sys.argv)\n    return 3\n"
    )
    write("ws/src/arm/arm/nod.py", "class Nodder:\n    @staticmethod\n    def run():\n        print('nod')\n")
    write("ws/src/hand/package.xml", "<package><name>hand</name></package>")
    write("ws/src/hand/setup.py", "from setuptools import setup\nsetup(name='hand', packages=['hand'])\n")
    return write("ws/src/hand/hand/__init__.py", "NAME = 'five fingers'\n").parents[2] / "arm"


class TestSources:
    def test_entry_points_of_setup_py_are_read(self, arm: Path) -> None:
        programs = find_source_programs(arm)
        assert programs.entry_points == {
            "wave": EntryPoint("arm.wave", "main"),
            "nod": EntryPoint("arm.nod", "Nodder.run"),
            "shake": EntryPoint("arm.shake", "main"),
        }

    def test_entry_points_of_setup_cfg_and_pyproject_are_read(self, write: Write) -> None:
        folder = write(
            "p/setup.cfg", "[options.entry_points]\nconsole_scripts =\n  a = p.a:main\n  b = p.b:main\n"
        ).parent
        write("p/pyproject.toml", '[project]\nname = "p"\n[project.scripts]\nc = "p.c:main"\n')
        assert find_source_programs(folder).names() == ["a", "b", "c"]

    def test_computed_entry_points_are_found_by_running_setup_py(self, write: Write) -> None:
        text = (
            "from setuptools import setup, find_packages\n"
            "setup(name='p', packages=find_packages(), scripts=['bin/old'],\n"
            "      entry_points={'console_scripts': [f'{n} = p.{n}:main' for n in ('x', 'y')]})\n"
        )
        folder = write("p/setup.py", text).parent
        write("p/bin/old", "#!/usr/bin/env python3\n")
        assert find_source_programs(folder).names() == ["old", "x", "y"]

    def test_failing_setup_py_has_no_programs(self, write: Write) -> None:
        text = "from setuptools import setup\nraise SystemExit(1)\nsetup(entry_points={'console_scripts': LIST})\n"
        assert find_source_programs(write("p/setup.py", text).parent).names() == []

    def test_cmake_programs_are_read(self, write: Write) -> None:
        folder = write(
            "p/CMakeLists.txt",
            "project(p)\nadd_executable(driver src/driver.cpp)\n"
            "install(TARGETS driver DESTINATION lib/${PROJECT_NAME})\n"
            'rclcpp_components_register_node(comp PLUGIN "p::Comp" EXECUTABLE comp_node)\n'
            "install(PROGRAMS scripts/look.py scripts/missing.py DESTINATION lib/${PROJECT_NAME})\n"
            "install(PROGRAMS scripts/see.py DESTINATION lib/${PROJECT_NAME} RENAME seer)\n",
        ).parent
        write("p/scripts/look.py", "")
        write("p/scripts/see.py", "")
        programs = find_source_programs(folder)
        assert programs.scripts == {"look.py": folder / "scripts/look.py", "seer": folder / "scripts/see.py"}
        assert programs.compiled == {"driver", "comp_node"}

    @pytest.mark.parametrize(
        "command",
        [
            'set_target_properties(p_driver PROPERTIES OUTPUT_NAME "driver" PREFIX "")',
            "set_property(TARGET p_driver PROPERTY OUTPUT_NAME driver)",
            "set_target_properties(p_driver PROPERTIES RUNTIME_OUTPUT_NAME driver)",
        ],
    )
    def test_output_name_is_name_of_program(self, write: Write, command: str) -> None:
        text = f"project(p)\nadd_executable(p_driver d.cpp)\n{command}\ninstall(TARGETS p_driver DESTINATION lib/p)\n"
        assert find_source_programs(write("p/CMakeLists.txt", text).parent).compiled == {"driver"}

    def test_programs_of_external_project_are_unknown(self, write: Write) -> None:
        build_file = "project(p)\ninclude(cmake/SuperBuild.cmake)\nreturn()\n"
        folder = write("p/CMakeLists.txt", build_file).parent
        write("p/cmake/SuperBuild.cmake", "include(ExternalProject)\nExternalProject_Add(ep SOURCE_DIR .)\n")
        assert not find_source_programs(folder).is_complete

    def test_entry_point_runs_without_build(self, arm: Path, finder: PackageFinder) -> None:
        executable = find_executable(finder, arm.name, "wave")
        assert executable.origin is Origin.SOURCE
        assert executable.path is not None
        assert executable.path.parts[-3:] == ("lib", "arm", "wave")
        result = subprocess.run([*executable.command, "--fast"], capture_output=True, text=True, check=False)
        assert result.returncode == 3, result.stderr
        assert result.stdout == f"five fingers ['{executable.path}', '--fast']\n"

    def test_generated_script_is_rewritten_only_if_changed(self, arm: Path, finder: PackageFinder) -> None:
        path = find_executable(finder, arm.name, "nod").path
        assert path is not None
        identity = path.stat().st_mtime_ns, path.stat().st_ino
        assert find_executable(finder, arm.name, "nod").path == path
        assert (path.stat().st_mtime_ns, path.stat().st_ino) == identity
        path.write_text("print('somebody else was here')")
        assert find_executable(finder, arm.name, "nod").path == path
        assert subprocess.run([path], capture_output=True, text=True, check=True).stdout == "nod\n"

    def test_missing_module_of_entry_point_is_reported(self, arm: Path, finder: PackageFinder) -> None:
        with pytest.raises(LinkwrightError, match=r"but module .arm\.shake. does not exist") as caught:
            find_executable(finder, arm.name, "shake")
        assert caught.value.diagnostics[0].code == "LAUNCH131"

    def test_unbuilt_compiled_program_has_build_hint(self, write: Write, finder: PackageFinder) -> None:
        write("ws/src/p/package.xml", "<package><name>p</name></package>")
        write("ws/src/p/CMakeLists.txt", "project(p)\nadd_executable(driver driver.cpp)\n")
        with pytest.raises(LookupError) as caught:
            find_executable(finder, "p", "driver")
        assert isinstance(caught.value, LinkwrightError)
        (diagnostic,) = caught.value.diagnostics
        assert diagnostic.message == "executable 'driver' of package 'p' is a compiled program that was not built"
        assert diagnostic.hint is not None
        assert diagnostic.hint.startswith("build it with 'colcon build --packages-select p'")

    @pytest.mark.parametrize(
        ("package", "name", "instead"),
        [
            ("rplidar_ros", "rplidar_composition", "a simulated `gpu_lidar`"),
            ("realsense2_camera", "realsense2_camera_node", "`usb_cam` with a video file"),
            ("nmea_navsat_driver", "nmea_serial_driver", "a simulated `navsat`"),
            ("turtlebot3_node", "turtlebot3_ros", "`mock_components/GenericSystem`"),
            ("ur_robot_driver", "dashboard_client", "`mock_components/GenericSystem`"),
            ("micro_ros_agent", "micro_ros_agent", "it drives hardware"),
            ("moveit_setup_assistant", "moveit_setup_assistant", "`linkwright arm init` writes"),
            ("rtabmap_slam", "rtabmap", "use `slam_toolbox` or `cartographer_ros`"),
            ("mavros", "mavros_node", "`gz-sim-multicopter-control-system`"),
            ("nav2_route", "route_server", "use `planner_server`"),
        ],
    )
    def test_missing_program_names_alternative(
        self, finder: PackageFinder, package: str, name: str, instead: str
    ) -> None:
        with pytest.raises(LinkwrightError, match=r"(was not found|runs without ROS); ") as caught:
            find_executable(finder, package, name)
        assert is_unavailable(caught.value)
        assert instead in caught.value.diagnostics[0].message

    @pytest.mark.parametrize("cmake", [None, "project(p)\ninclude(cmake/programs.cmake)\n"])
    def test_program_unknown_to_sources_is_unavailable(
        self, write: Write, finder: PackageFinder, cmake: str | None
    ) -> None:
        write("ws/src/p/package.xml", "<package><name>p</name></package>")
        if cmake is not None:
            write("ws/src/p/CMakeLists.txt", cmake)
        with pytest.raises(LinkwrightError) as caught:
            find_executable(finder, "p", "motion_control")
        assert caught.value.diagnostics[0].message == "executable 'motion_control' of package 'p' is not available"
        assert is_unavailable(caught.value)

    def test_misspelled_program_is_reported(self, write: Write, finder: PackageFinder) -> None:
        write("ws/src/p/package.xml", "<package><name>p</name></package>")
        write(
            "ws/src/p/CMakeLists.txt", "project(p)\nadd_executable(driver driver.cpp)\ninclude(cmake/programs.cmake)\n"
        )
        with pytest.raises(LinkwrightError, match="has no executable") as caught:
            find_executable(finder, "p", "drivr")
        assert not is_unavailable(caught.value)

    def test_suggestion_includes_compiled_programs(self, write: Write, finder: PackageFinder) -> None:
        write("ws/src/p/package.xml", "<package><name>p</name></package>")
        write("ws/src/p/CMakeLists.txt", "project(p)\nadd_executable(driver driver.cpp)\n")
        with pytest.raises(LinkwrightError) as caught:
            find_executable(finder, "p", "drivr")
        assert caught.value.diagnostics[0].hint == "did you mean 'driver'?"


class TestInstalled:
    def test_built_program_takes_precedence_over_source(self, write: Write) -> None:
        write("ws/install/.colcon_install_layout", "isolated")
        write("ws/install/arm/share/arm/package.xml", "<package><name>arm</name></package>")
        built = write("ws/install/arm/lib/arm/wave", "#!/bin/sh\necho built\n")
        built.chmod(0o755)
        write("ws/install/arm/lib/arm/notes.txt", "no program")
        folder = built.parents[4]
        write("ws/src/arm/package.xml", "<package><name>arm</name></package>")
        write("ws/src/arm/setup.py", SETUP)
        finder = PackageFinder(start=folder, environment={})
        assert {name: executable.path for name, executable in find_executables(finder, "arm").items()} == {
            "wave": built
        }
        assert find_executable(finder, "arm", "wave").command == [str(built)]

    def test_unsourced_workspace_environment_is_created(self, write: Write) -> None:
        write("ws/install/.colcon_install_layout", "isolated")
        share = write("ws/install/arm/share/arm/package.xml", "<package><name>arm</name></package>").parent
        write("ws/install/arm/share/arm/hook/pythonpath_develop.dsv", "prepend-non-duplicate;PYTHONPATH;/ws/build/arm")
        modules = write("ws/install/arm/lib/python3.11/site-packages/arm.py", "").parent
        prefix = share.parents[1]
        finder = PackageFinder(start=prefix.parents[1], environment={})
        environment = make_workspace_environment(finder, {"PYTHONPATH": "/own"})
        assert environment["AMENT_PREFIX_PATH"] == str(prefix)
        folders = environment["PYTHONPATH"].split(os.pathsep)
        assert folders[:3] == ["/own", str(modules), "/ws/build/arm"]
        assert environment["LINKWRIGHT_START"] == str(prefix.parents[1])
        sourced = make_workspace_environment(finder, {"AMENT_PREFIX_PATH": str(prefix)})
        assert str(modules) not in sourced.get("PYTHONPATH", "")

    def test_finder_starts_at_folder_of_launcher(self, arm: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setenv("LINKWRIGHT_START", str(arm))
        assert PackageFinder().find("arm") == arm

    @pytest.mark.parametrize("line", [f"#!{sys.executable}", "#!/bin/sh", "", "#!/no/such/python3"])
    def test_scripts_with_suitable_interpreter_run_unchanged(self, write: Write, line: str) -> None:
        assert not needs_our_interpreter(write("script", f"{line}\nprint()\n"))

    def test_script_for_older_python_uses_own_interpreter(self, write: Write, tmp_path: Path) -> None:
        other = write("python3", "#!/bin/sh\necho 3 4\n")
        other.chmod(0o755)
        assert needs_our_interpreter(write("script", f"#!{other}\nprint()\n"))


class TestBuiltinExecutables:
    def test_builtin_packages_and_executables_are_listed(self, finder: PackageFinder) -> None:
        assert {"robot_state_publisher", "tf2_ros", "rviz2", "rclcpp_components"} <= builtin_packages()
        executables = find_executables(finder, "robot_state_publisher")
        assert str(executables["robot_state_publisher"]) == "built into Linkwright"

    def test_builtin_nodes_run_as_processes(self, finder: PackageFinder) -> None:
        executable = find_executable(finder, "tf2_ros", "static_transform_publisher")
        assert executable.command[1:] == ["-m", "linkwright.node_program", "tf2_ros", "static_transform_publisher"]

    def test_executable_in_package_returns_runnable_file(self, finder: PackageFinder) -> None:
        with use_finder(finder):
            path = ExecutableInPackage("static_transform_publisher", "tf2_ros").perform(LaunchContext())
        result = subprocess.run([path, "--nonsense"], capture_output=True, text=True, check=False)
        assert result.returncode == 1
        assert "error parsing command line arguments" in result.stderr


async def test_script_installed_by_cmake_imports_its_package(launch, write: Write, finder: PackageFinder) -> None:
    write("ws/src/p/package.xml", "<package><name>p</name></package>")
    write(
        "ws/src/p/CMakeLists.txt",
        "project(p)\nament_python_install_package(${PROJECT_NAME})\n"
        "install(PROGRAMS scripts/look.py scripts/list.sh DESTINATION lib/${PROJECT_NAME})\n",
    )
    write("ws/src/p/p/__init__.py", "WORD = 'seen'\n")
    write("ws/src/p/scripts/look.py", "import p\nprint(p.WORD)\n")  # neither executable nor with a shebang line
    write("ws/src/p/scripts/list.sh", "#!/bin/sh\necho $0 $1\n")
    nodes = [Node(package="p", executable=name, arguments=["x"], output="screen") for name in ("look.py", "list.sh")]
    result = await launch(*nodes, finder=finder)
    assert "[look.py-1] seen" in result.out, result.err
    assert "list.sh x" in result.out


async def test_node_of_source_package_is_started(launch, arm: Path, finder: PackageFinder) -> None:
    result = await launch(Node(package=arm.name, executable="wave", output="screen"), finder=finder)
    assert "[wave-1] five fingers" in result.out
    assert "[ERROR] [wave-1]: process has died [pid " in result.err
    assert "exit code 3" in result.err
