"""``linkwright launch`` and its options."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright.cli import main

Write = Callable[[str], Path]

HEAD = """
import sys
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, LogInfo
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([{}])
"""
PRINTS = "ExecuteProcess(cmd=[sys.executable, '-c', 'print(\"out\")'], name='py')"


@pytest.fixture
def write_launch_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Write:
    """Write a launch file with entities."""
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "logs"))
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")

    def write_file(*entities: str) -> Path:
        path = tmp_path / "a.launch.py"
        path.write_text(HEAD.format(", ".join(entities)))
        return path

    return write_file


def run_launch(*words: object) -> subprocess.CompletedProcess[str]:
    program = "import sys; from linkwright.cli import main; sys.exit(main())"
    return subprocess.run(
        [sys.executable, "-c", program, "launch", *map(str, words)],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def test_process_output_goes_to_log_by_default(write_launch_file: Write, tmp_path: Path) -> None:
    path = write_launch_file(PRINTS)
    output_by_default = run_launch(path)
    assert output_by_default.returncode == 0
    assert output_by_default.stdout == ""
    assert "[py-1] out" in (tmp_path / "logs" / "latest" / "launch.log").read_text()
    assert run_launch("-a", path).stdout == "[py-1] out\n"


def test_debug_option_sets_log_level(write_launch_file: Write) -> None:
    result = run_launch("--debug", write_launch_file(PRINTS))
    assert "[INFO] [launch]: Default logging verbosity is set to DEBUG" in result.stderr
    assert "[DEBUG] [launch]: processing event: 'launch.events.process.ProcessStarted'" in result.stderr


def test_launch_prefix_applies_to_filtered_programs(write_launch_file: Write) -> None:
    path = write_launch_file("ExecuteProcess(cmd=['echo', 'a'])", "ExecuteProcess(cmd=['true', 'b'])")
    result = run_launch("-a", "--launch-prefix", "echo before", "--launch-prefix-filter", "tr", path)
    assert sorted(result.stdout.splitlines()) == ["[echo-1] a", "[true-2] before true b"]


def test_isolate_starts_separate_process(write_launch_file: Write) -> None:
    node = "Node(package='demo_nodes_py', executable='talker_qos', arguments=['-n', '1'])"
    assert "[talker_qos-1]: started in the launcher's process" in run_launch(write_launch_file(node)).stderr
    assert "[talker_qos-1]: process started with pid [" in run_launch("--isolate", write_launch_file(node)).stderr


def test_print_option_shows_launch_description(write_launch_file: Write, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_launch_file("LogInfo(msg='hello')", "Node(package='p', executable='e', name='n')")
    assert main(["launch", "--print", str(path)]) == 0
    out = capsys.readouterr().out
    assert out.startswith("LaunchDescription(2 entities)\n")
    assert "Node(cmd=[ExecInPkg(pkg='p', exec='e'), '--ros-args', '-r'," in out


def test_show_arguments_and_short_option_are_equivalent(
    write_launch_file: Write, capsys: pytest.CaptureFixture[str]
) -> None:
    path = str(write_launch_file("DeclareLaunchArgument('gui', default_value='true')"))
    assert main(["launch", "--show-arguments", path]) == 0
    listing = capsys.readouterr().out
    assert "'gui':" in listing
    assert main(["launch", "-s", path]) == 0
    assert capsys.readouterr().out == listing
