"""Measure launches: from the command to the last started node, in one process, isolated, and many at once.

Times are wall times of the whole program as a user meets it, `linkwright` started anew each time with a warm file
cache.
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

RUNS = 9
MANY = 500

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
_STARTED = ("started in the launcher's process", "process started with pid")
_ISOLATED = ("Spinning until stopped",)


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    with tempfile.TemporaryDirectory(prefix="linkwright-bench-") as folder:
        four = _file(folder, "four", "FOUR")
        alike = _file(folder, "alike", "[frames(number) for number in range(4)]")
        many = _file(folder, "many", f"[frames(number) for number in range({MANY})]")
        return [
            Row("four nodes up, from the command", _median(_STARTED, 4, four), "s", "0.5 s"),
            Row("four nodes up, each in a process of its own", _median(_ISOLATED, 4, "--isolate", alike, runs=3), "s"),
            Row(f"{MANY} nodes up, from the command", _median(_STARTED, MANY, many, runs=3), "s"),
            Row(f"{MANY} nodes down, from Ctrl-C", _ended(_STARTED, MANY, many), "s"),
        ]


def _file(folder: str, name: str, entities: str) -> str:
    path = Path(folder, f"{name}.launch.py")
    path.write_text(_HEAD % entities, encoding="utf-8")
    return str(path)


def _median(signs: tuple[str, ...], count: int, *words: str, runs: int = RUNS) -> float:
    return statistics.median(_measured(signs, count, *words)[0] for _ in range(runs))


def _ended(signs: tuple[str, ...], count: int, *words: str) -> float:
    return statistics.median(_measured(signs, count, *words)[1] for _ in range(3))


def _measured(signs: tuple[str, ...], count: int, *words: str) -> tuple[float, float]:
    """Return the seconds from the command to `count` lines with the signs, and from Ctrl-C to the end."""
    environment = {**os.environ, "ROS_DOMAIN_ID": "89"}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    begin = time.perf_counter()
    with subprocess.Popen(
        [LINKWRIGHT, "launch", *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment
    ) as process:
        assert process.stdout is not None
        seen = 0
        for line in process.stdout:
            seen += any(sign in line for sign in signs)
            if seen == count:
                break
        up = time.perf_counter() - begin
        begin = time.perf_counter()
        process.send_signal(signal.SIGINT)
        process.communicate()
        return up, time.perf_counter() - begin
