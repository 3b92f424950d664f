"""Ctrl-C while a command has much to do.

It ends with the status for that, and without a traceback.
"""

from __future__ import annotations

import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import psutil
import pytest

from tests.begun import BEGUN, command_that_reports
from tests.waiting import TIMEOUT_S, wait_until

DELAYS_S = (0.0, 0.5, 1.0)
"""The times of the interrupts: seconds of processor time since the start of the command."""

_PART = "".join(
    f'<part{number} a="${{n + {number}}}" b="${{n * {number}}}" c="${{[n, {number}]}}"/>' for number in range(400)
)
HARD_ROBOT = (
    '<robot name="hard" xmlns:xacro="http://ros.org/wiki/xacro">'
    f'<xacro:macro name="many" params="n"><gazebo>{_PART}</gazebo></xacro:macro>'
    + "".join(f'<xacro:many n="{number}"/>' for number in range(1000))
    + '<link name="base"/></robot>'
)
"""An expansion that only the time limit of 20 s of processor time ends."""
ENDLESS_LAUNCH = "def generate_launch_description():\n    while True:\n        sum(range(1000))\n"

COMMANDS = [
    ["xacro", "hard.xacro"],
    ["check", "hard.xacro"],
    ["inertia", "hard.xacro"],
    ["diagram", "hard.xacro"],
    ["export", "hard.glb", "hard.xacro"],
    ["view", "--no-open", "hard.xacro"],
    ["launch", "--print", "endless.launch.py"],
]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot send SIGINT to one process")
@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: words[0])
def test_busy_command_ends_on_interrupt(words: list[str], tmp_path: Path) -> None:
    (tmp_path / "hard.xacro").write_text(HARD_ROBOT)
    (tmp_path / "endless.launch.py").write_text(ENDLESS_LAUNCH)
    for interrupt_point in DELAYS_S:
        process = subprocess.Popen(
            command_that_reports("linkwright", *words),
            cwd=tmp_path,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == BEGUN + "\n"
            watched = psutil.Process(process.pid)
            work_before = _processor_time(watched)
            wait_until(lambda: _processor_time(watched) >= work_before + interrupt_point, what=words)  # noqa: B023 - called at once
            process.send_signal(signal.SIGINT)
            _, output = process.communicate(timeout=TIMEOUT_S)
        finally:
            process.kill()
            process.wait()
        assert process.returncode == 130, output
        assert "Traceback" not in output


def _processor_time(process: psutil.Process) -> float:
    """Return the processor time of a process and its children so far, in seconds."""
    total = 0.0
    for worker in (process, *process.children(recursive=True)):
        with suppress(psutil.NoSuchProcess):
            cpu_times = worker.cpu_times()
            total += cpu_times.user + cpu_times.system
    return total
