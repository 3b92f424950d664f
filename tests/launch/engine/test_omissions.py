"""What is left out of a launch because something that it needs is not there."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from launch.actions import DeclareLaunchArgument, ExecuteProcess, IncludeLaunchDescription, LogInfo
from launch.substitutions import Command, FindExecutable, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

Write = Callable[[str, str], Path]
SKIP = {"skip_missing": True}


async def test_all_that_is_missing_is_left_out_and_listed_once(launch, write: Write) -> None:
    (missing_module, missing_file) = (
        write("module.launch.py", "import no_such_module\n"),
        write("package.launch.py", "").with_name("no_such.launch.py"),
    )
    done = await launch(
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
    assert done.messages == ["the rest runs"]
    assert done.succeeded
    assert done.err.count("warning[LAUNCH146]: 7 parts of the launch are left out, the rest runs") == 1
    assert "error" not in done.err
    for named in ("no_such_package", "no_such_program", "no_such_share", "no-such-executable", "no_such_module"):
        assert named in done.err


async def test_what_needs_a_value_of_what_is_left_out_goes_with_it(launch) -> None:
    done = await launch(
        DeclareLaunchArgument("folder", default_value=FindPackageShare("no_such_package")),
        LogInfo(msg=LaunchConfiguration("folder")),
        LogInfo(msg="the rest runs"),
        session_options=SKIP,
    )
    assert done.messages == ["the rest runs"]
    assert "2 parts of the launch are left out" in done.err
    assert done.succeeded


async def test_a_program_that_cannot_be_started(launch) -> None:
    done = await launch(ExecuteProcess(cmd=["/no/such/program"]), LogInfo(msg="rest"), session_options=SKIP)
    assert done.messages == ["rest"]
    assert "one part of the launch is left out" in done.err
    assert done.succeeded


async def test_other_mistakes_end_the_launch_all_the_same(launch) -> None:
    done = await launch(LogInfo(msg=LaunchConfiguration("typo")), LogInfo(msg="rest"), session_options=SKIP)
    assert done.messages == []
    assert not done.succeeded


async def test_the_error_offers_the_command(launch) -> None:
    options = {"command_to_skip_missing": "linkwright launch --skip-missing a.launch.py"}
    done = await launch(Node(package="no_such_package", executable="driver"), session_options=options)
    assert "to run what can run without it: linkwright launch --skip-missing a.launch.py" in done.err
    assert not done.succeeded
    done = await launch(LogInfo(msg=LaunchConfiguration("typo")), session_options=options)
    assert "--skip-missing" not in done.err
