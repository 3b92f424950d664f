"""Measure launches, from the command to the last started node.

Nodes run in one process or isolated, and few or many of them are launched. Times are wall times of the whole program as
for a user: each run is a new `linkwright` process with a warm file cache.
"""

from __future__ import annotations

import os
import signal
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

from benchmarks.measure import LINKWRIGHT, Row

RUN_COUNT = 9
MANY_NODES = 500

_HEAD = """
from launch import LaunchDescription
from launch.actions import ExecuteProcess
from launch_ros.actions import Node

URDF = '<robot name="r"><link name="base"/><link name="arm"/><joint name="j" type="continuous">' \\
    '<parent link="base"/><child link="arm"/></joint></robot>'


def frames(number):
    return Node(package='tf2_ros', executable='static_transform_publisher', name=f'frames_{number}',
                arguments=['--frame-id', 'base', '--child-frame-id', f'frame_{number}'])


FOUR = [
    Node(package='robot_state_publisher', executable='robot_state_publisher', parameters=[{'robot_description': URDF}]),
    Node(package='joint_state_publisher', executable='joint_state_publisher', parameters=[{'robot_description': URDF}]),
    frames(0),
    Node(package='demo_nodes_cpp', executable='talker'),
]


def generate_launch_description():
    return LaunchDescription(%s)
"""
_STARTED_SIGNS = ("started in the launcher's process", "process started with pid")
_ISOLATED_SIGNS = ("Spinning until stopped",)


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    with tempfile.TemporaryDirectory(prefix="linkwright-bench-") as folder:
        four_nodes_file = _write_file(folder, "four", "FOUR")
        frames_file = _write_file(folder, "alike", "[frames(number) for number in range(4)]")
        many = _write_file(folder, "many", f"[frames(number) for number in range({MANY_NODES})]")
        return [
            Row(
                "four nodes up, from the command",
                _measure_median_start(_STARTED_SIGNS, 4, four_nodes_file),
                "s",
                "0.5 s",
            ),
            Row(
                "four nodes up, each in a process of its own",
                _measure_median_start(_ISOLATED_SIGNS, 4, "--isolate", frames_file, runs=3),
                "s",
            ),
            Row(
                f"{MANY_NODES} nodes up, from the command",
                _measure_median_start(_STARTED_SIGNS, MANY_NODES, many, runs=3),
                "s",
            ),
            Row(f"{MANY_NODES} nodes down, from Ctrl-C", _measure_end(_STARTED_SIGNS, MANY_NODES, many), "s"),
        ]


def _write_file(folder: str, name: str, entities: str) -> str:
    path = Path(folder, f"{name}.launch.py")
    path.write_text(_HEAD % entities, encoding="utf-8")
    return str(path)


def _measure_median_start(signs: tuple[str, ...], count: int, *words: str, runs: int = RUN_COUNT) -> float:
    return statistics.median(_measure(signs, count, *words)[0] for _ in range(runs))


def _measure_end(signs: tuple[str, ...], count: int, *words: str) -> float:
    return statistics.median(_measure(signs, count, *words)[1] for _ in range(3))


def _measure(signs: tuple[str, ...], count: int, *words: str) -> tuple[float, float]:
    """Return the seconds from the command until `count` lines have signs, and from Ctrl-C to the end."""
    environment = {**os.environ, "ROS_DOMAIN_ID": "89"}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    begin = time.perf_counter()
    with subprocess.Popen(
        [LINKWRIGHT, "launch", *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment
    ) as process:
        assert process.stdout is not None
        sign_count = 0
        for line in process.stdout:
            sign_count += any(sign in line for sign in signs)
            if sign_count == count:
                break
        up = time.perf_counter() - begin
        begin = time.perf_counter()
        process.send_signal(signal.SIGINT)
        process.communicate()
        return up, time.perf_counter() - begin
