"""The processes of the `linkwright` command and of users' programs.

The tests also check the processes that these leave.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

import psutil

from linkwright.standins.process import create_environment
from tests.begun import BEGUN, command_that_reports
from tests.waiting import TIMEOUT_S, wait_until

LINKWRIGHT = str(Path(sys.executable).with_name("linkwright"))
PROGRAM = """\
import sys, time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Int32, String

EVERYTHING = QoSProfile(depth=0, history=HistoryPolicy.KEEP_ALL)


def say(*words):
    print(*words, flush=True)


{program}

rclpy.init()
node = None
try:
    node = Program()
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
finally:
    if node is not None:
        node.destroy_node()
    rclpy.try_shutdown()
"""
PROCESS_MARK = "LINKWRIGHT_RELIABILITY"


class RunningProcess:
    """A process and the lines that it has written, standard output and errors together."""

    def __init__(self, command: list[str], variables: Mapping[str, str], folder: Path) -> None:
        self.mark = f"{os.getpid()}-{time.monotonic_ns()}"
        self.process = subprocess.Popen(
            command,
            env={**os.environ, **variables, PROCESS_MARK: self.mark},
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        self.lines: list[str] = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    @property
    def text(self) -> str:
        return "".join(self.lines)

    def count(self, text: str) -> int:
        """Return the number of lines that contain a text."""
        return sum(text in line for line in self.lines)

    def last_number(self, word: str) -> int:
        """Return the number after a word in the last line that begins with it, or -1."""
        rows = [line.split() for line in tuple(self.lines) if line.split()[:1] == [word]]
        return int(rows[-1][1]) if rows else -1

    def wait_for(self, text: str, seconds: float = TIMEOUT_S, times: int = 1) -> None:
        """Wait until a number of lines contain a text."""
        wait_until(lambda: self.count(text) >= times, seconds, lambda: f"'{text}' in\n{self.text}")

    def interrupt(self) -> int:
        """Interrupt the process as Ctrl-C does, and return its exit status."""
        with suppress(ProcessLookupError):
            self.process.send_signal(signal.SIGINT)
        return self.wait()

    def kill(self) -> None:
        """Kill the process as ``kill -9`` does."""
        self.process.kill()
        self.process.wait()

    def wait(self, seconds: float = TIMEOUT_S) -> int:
        """Wait for the end of the process, and return its exit status."""
        status = self.process.wait(seconds)
        self._reader.join(60.0)
        return status

    def left_behind(self) -> list[psutil.Process]:
        """Return the processes that it started and that still run, including itself."""
        return [process for process in psutil.process_iter() if _is_marked(process, self.mark)]

    def clean_up(self) -> None:
        """End all remaining processes, and close all files."""
        for process in self.left_behind():
            with suppress(psutil.Error):
                process.kill()
        self.process.wait(60.0)
        self._reader.join(60.0)
        assert self.process.stdout is not None
        self.process.stdout.close()

    def _read(self) -> None:
        assert self.process.stdout is not None
        with suppress(ValueError):
            for line in self.process.stdout:
                self.lines.append(line)


def _is_marked(process: psutil.Process, mark: str) -> bool:
    try:
        return process.status() != psutil.STATUS_ZOMBIE and process.environ().get(PROCESS_MARK) == mark
    except psutil.Error:
        return False


class Machine:
    """Starts processes in a common domain, and in a folder that only the test uses."""

    def __init__(self, folder: Path, domain: int) -> None:
        self.folder = folder
        self.variables = {
            "ROS_DOMAIN_ID": str(domain),
            "ROS_LOG_DIR": str(folder / "ros_log"),
            "XDG_CACHE_HOME": str(folder / "cache"),
            "PYTHONUNBUFFERED": "1",
        }
        self._started: list[RunningProcess] = []
        self.before: tuple[str, ...] = ()
        """The words before each command, such as a shell that executes the command after a preparation."""

    def command(self, *words: object, **variables: str) -> RunningProcess:
        """Start ``linkwright WORDS``."""
        return self._start([LINKWRIGHT, *map(str, words)], variables)

    def start_handling_interrupts(self, *words: object, module: str = "linkwright") -> RunningProcess:
        """Start ``python -m MODULE WORDS``, and wait until it handles Ctrl-C."""
        running = self._start(command_that_reports(module, *map(str, words)), {})
        running.wait_for(BEGUN)
        running.lines.remove(f"{BEGUN}\n")
        return running

    def verb(self, *words: object, seconds: float = TIMEOUT_S, **variables: str) -> str:
        """Return the output of ``linkwright WORDS``, which must succeed in time."""
        running = self.command(*words, **variables)
        status = running.wait(seconds)
        assert status == 0, running.text
        return running.text

    def launch(self, path: Path, *words: object, **variables: str) -> RunningProcess:
        """Start a launch."""
        return self.command("launch", path, *words, "--no-open", **variables)

    def program(self, text: str, *words: object, **variables: str) -> RunningProcess:
        """Start a user's program: a class ``Program`` derived from ``Node``."""
        path = self.write(f"program_{len(self._started)}.py", program_text(text))
        return self._start([sys.executable, str(path), *map(str, words)], {**create_environment({}), **variables})

    def python(self, *words: object) -> RunningProcess:
        """Start a module or script of the tests."""
        return self._start([sys.executable, *map(str, words)], {"PYTHONPATH": str(Path(__file__).parents[2])})

    def write(self, name: str, text: str) -> Path:
        """Write a file."""
        path = self.folder / name
        path.write_text(textwrap.dedent(text), encoding="utf-8")
        return path

    def _start(self, command: list[str], variables: Mapping[str, str]) -> RunningProcess:
        self._started.append(RunningProcess([*self.before, *command], {**self.variables, **variables}, self.folder))
        return self._started[-1]

    def clean_up(self) -> None:
        for running in self._started:
            running.clean_up()


def program_text(text: str) -> str:
    """Return the text of a program around its class ``Program``."""
    return PROGRAM.replace("{program}", textwrap.dedent(text).strip())


def launch_file_text(*actions: str) -> str:
    """Return a launch file with actions.

    ``rclpy_node(name, path)`` runs a program with respawn.
    """
    lines = ",\n        ".join(actions)
    return (
        "import sys\nfrom launch import LaunchDescription\nfrom launch.actions import *\n"
        "from launch_ros.actions import Node\n\n\n"
        f"def generate_launch_description():\n    return LaunchDescription([\n        {lines}\n    ])\n"
    )
