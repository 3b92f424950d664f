"""The parts that a launch skips because a package, program or file is missing."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from launch.actions import DeclareLaunchArgument, ExecuteProcess, IncludeLaunchDescription, LogInfo
from launch.substitutions import Command, FindExecutable, LaunchConfiguration
from launch_ros.actions import ComposableNodeContainer, Node
from launch_ros.descriptions import ComposableNode
from launch_ros.substitutions import FindPackageShare

from linkwright.packages import PackageFinder
from tests.launch.ending import end_when, has_printed

Write = Callable[[str, str], Path]
SKIP = {"skip_missing": True}


async def test_missing_parts_are_skipped_and_listed_once(launch, write: Write) -> None:
    (missing_module, missing_file) = (
        write("module.launch.py", "import no_such_module\n"),
        write("package.launch.py", "").with_name("no_such.launch.py"),
    )
    result = await launch(
        Node(package="no_such_package", executable="driver"),
        Node(package="demo_nodes_py", executable="no_such_program"),
        LogInfo(msg=FindPackageShare("no_such_share")),
        LogInfo(msg=FindExecutable(name="no-such-executable")),
        LogInfo(msg=Command(["xacro ", "/no/such/robot.xacro"])),
        IncludeLaunchDescription(str(missing_module)),
        IncludeLaunchDescription(str(missing_file)),
        LogInfo(msg="the rest runs"),
        session_options=SKIP,
    )
    assert result.messages == ["the rest runs"]
    assert result.succeeded
    assert result.err.count("warning[LAUNCH146]: 7 parts of the launch are skipped, and the rest runs") == 1
    assert "error" not in result.err
    for name in ("no_such_package", "no_such_program", "no_such_share", "no-such-executable", "no_such_module"):
        assert name in result.err


async def test_actions_that_depend_on_missing_value_are_skipped(launch) -> None:
    result = await launch(
        DeclareLaunchArgument("folder", default_value=FindPackageShare("no_such_package")),
        LogInfo(msg=LaunchConfiguration("folder")),
        LogInfo(msg="the rest runs"),
        session_options=SKIP,
    )
    assert result.messages == ["the rest runs"]
    assert "2 parts of the launch are skipped" in result.err
    assert result.succeeded


async def test_missing_program_is_skipped(launch) -> None:
    result = await launch(ExecuteProcess(cmd=["/no/such/program"]), LogInfo(msg="rest"), session_options=SKIP)
    assert result.messages == ["rest"]
    assert "one part of the launch is skipped" in result.err
    assert result.succeeded


async def test_other_errors_end_launch(launch) -> None:
    result = await launch(LogInfo(msg=LaunchConfiguration("typo")), LogInfo(msg="rest"), session_options=SKIP)
    assert result.messages == []
    assert not result.succeeded


async def test_error_offers_skip_missing_command(launch) -> None:
    options = {"command_to_skip_missing": "linkwright launch --skip-missing a.launch.py"}
    result = await launch(Node(package="robot_state_publishr", executable="driver"), session_options=options)
    assert "to launch without this part, run linkwright launch --skip-missing a.launch.py" in result.err
    assert not result.succeeded
    result = await launch(LogInfo(msg=LaunchConfiguration("typo")), session_options=options)
    assert "--skip-missing" not in result.err


class TestMissingPackagesByDefault:
    """Parts that need missing third-party packages are skipped by default.

    Robots start many such parts.
    """

    async def test_nodes_of_missing_packages_are_skipped(self, launch) -> None:
        result = await launch(
            Node(package="moveit_hybrid_planning", executable="hybrid_planning_manager"),
            Node(package="nav2_route", executable="route_server"),
            Node(package="robot_localization", executable="estimate_all"),
            ExecuteProcess(cmd=[sys.executable, "-c", "print('the rest runs')"], output="screen"),
        )
        assert "the rest runs" in result.out
        assert "3 parts of the launch are skipped, and the rest runs" in result.err
        assert "test_omissions.py" in result.err
        assert "error" not in result.err
        assert result.succeeded

    async def test_launch_with_only_missing_parts_fails(self, launch) -> None:
        result = await launch(Node(package="moveit_hybrid_planning", executable="hybrid_planning_manager"))
        assert "one part of the launch is skipped" in result.err
        assert not result.succeeded

    async def test_includes_from_missing_packages_are_skipped(self, launch, write: Write) -> None:
        asks = "from ament_index_python.packages import get_package_share_directory as share\nshare('zzz_of_others')\n"
        files = (write("imports.launch.py", "import zzz_config_of_others\n"), write("asks.launch.py", asks))
        result = await launch(
            IncludeLaunchDescription([FindPackageShare("zzz_of_others"), "/launch/robot.launch.py"]),
            IncludeLaunchDescription([FindPackageShare("gazebo_ros"), "/launch/of_another_release.launch.py"]),
            *(IncludeLaunchDescription(str(file)) for file in files),
            ExecuteProcess(cmd=[sys.executable, "-c", "print('the rest runs')"], output="screen"),
        )
        assert "the rest runs" in result.out
        assert "4 parts of the launch are skipped, and the rest runs" in result.err
        assert result.succeeded

    async def test_unbuilt_compiled_node_is_skipped(self, launch, tmp_path: Path) -> None:
        (tmp_path / "package.xml").write_text("<package><name>of_others</name></package>")
        (tmp_path / "CMakeLists.txt").write_text(
            "add_executable(driver src/driver.cpp)\ninstall(TARGETS driver DESTINATION lib/${PROJECT_NAME})\n"
        )
        finder = PackageFinder(start=tmp_path)
        for name, is_left_out in (("driver", True), ("drivr", False)):
            result = await launch(Node(package="of_others", executable=name), LogInfo(msg="rest"), finder=finder)
            assert (result.messages == ["rest"]) is is_left_out
            assert ("is skipped" in result.err) is is_left_out

    async def test_component_of_missing_package_is_skipped(self, launch) -> None:
        result = await launch(
            ComposableNodeContainer(
                name="box",
                namespace="",
                package="rclcpp_components",
                executable="component_container",
                composable_node_descriptions=[ComposableNode(package="zzz_of_others", plugin="zzz::Driver")],
            ),
            end_when(has_printed("skipped")),
        )
        assert "one part of the launch is skipped, and the rest runs" in result.err
        assert "'zzz::Driver'" in result.err
        assert result.succeeded

    async def test_missing_drivers_name_what_takes_their_place(self, launch) -> None:
        result = await launch(
            Node(package="rplidar_ros", executable="rplidar_composition"),
            IncludeLaunchDescription([FindPackageShare("realsense2_camera"), "/launch/rs_launch.py"]),
            ComposableNodeContainer(
                name="box",
                namespace="",
                package="rclcpp_components",
                executable="component_container",
                composable_node_descriptions=[ComposableNode(package="ouster_ros", plugin="ouster_ros::OusterSensor")],
            ),
            end_when(has_printed("OusterSensor")),
        )
        texts = " ".join(result.err.split())
        assert texts.count("; it drives a laser scanner, so build and start it on the robot") == 2
        assert texts.count("package 'realsense2_camera' not found; it drives a camera") == 1
        assert "error" not in result.err
        assert result.succeeded

    async def test_misspelled_names_end_launch(self, launch, write: Write) -> None:
        for misspelled in (
            Node(package="robot_state_publishr", executable="robot_state_publisher"),
            Node(package="robot_state_publisher", executable="robot_state_publishr"),
            IncludeLaunchDescription(str(write("there.launch.py", "").with_name("ther.launch.py"))),
        ):
            result = await launch(misspelled, LogInfo(msg="rest"))
            assert result.messages == []
            assert "skipped" not in result.err
            assert not result.succeeded
