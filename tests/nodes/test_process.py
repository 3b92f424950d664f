"""Our nodes as separate processes, which communicate over DDS."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from threading import Thread

import pytest

from linkwright.nodes.process import main
from linkwright.wire.dds import unavailable_reason
from tests.domains import own_domain
from tests.waiting import TIMEOUT_S

needs_network = pytest.mark.skipif(bool(unavailable_reason()), reason="cyclonedds is not installed")


class Program:
    """A process, and the lines that it has written to both streams so far."""

    def __init__(self, arguments: list[str], environment: dict[str, str]) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "linkwright.node_program", *arguments],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.lines: list[str] = []
        self._reader = Thread(target=self._read)
        self._reader.start()

    def wait_for(self, text: str, seconds: float = TIMEOUT_S) -> str:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for line in self.lines:
                if text in line:
                    return line
            time.sleep(0.02)
        raise AssertionError(f"'{text}' was not printed: {self.lines}")

    def end(self, number: signal.Signals = signal.SIGINT) -> int:
        """Send a signal unless the process has ended, and return the exit status."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        status = self.process.wait(TIMEOUT_S)
        self._reader.join()
        assert self.process.stdout is not None
        self.process.stdout.close()
        return status

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.lines.append(line.rstrip("\n"))


@pytest.fixture
def start_program(tmp_path: Path) -> Iterator[Callable[..., Program]]:
    programs: list[Program] = []
    environment = {
        **os.environ,
        "ROS_DOMAIN_ID": str(own_domain()),
        "ROS_LOG_DIR": str(tmp_path / "log"),
        "PYTHONUNBUFFERED": "1",
        "PYTHONPATH": str(Path(__file__).resolve().parents[2] / "src"),
    }

    def run(*arguments: str, **more: str) -> Program:
        program = Program(list(arguments), environment | more)
        programs.append(program)
        return program

    yield run
    for program in programs:
        if program.process.poll() is None:
            program.end(signal.SIGKILL)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_node_process_ends_cleanly_on_signal(start_program, tmp_path, number):
    program = start_program(
        *("tf2_ros", "static_transform_publisher", "--frame-id", "a", "--child-frame-id", "b"),
        *("--ros-args", "-r", "__node:=mine", "-r", "__ns:=/robot"),
        LINKWRIGHT_DDS="0",
    )
    line = program.wait_for("Spinning until stopped - publishing transform")
    assert line.startswith("[INFO] [")
    assert "] [robot.mine]: " in line
    assert program.end(number) == 0
    assert not any("Traceback" in line for line in program.lines)
    (file,) = (tmp_path / "log").iterdir()
    assert file.name.startswith(f"static_transform_publisher_{program.process.pid}_")
    assert file.read_text().splitlines()[0] == line


def test_startup_error_is_reported(start_program):
    program = start_program("robot_state_publisher", "robot_state_publisher", LINKWRIGHT_DDS="0")
    assert program.process.wait(60) == 1
    program.end()
    text = "\n".join(program.lines)
    assert "[FATAL]" in text
    assert "error[NODE101]: robot_description parameter must not be empty" in text
    assert "Traceback" not in text


@pytest.mark.parametrize(
    ("package", "executable", "message", "hint"),
    [
        ("tf2_rs", "tf2_echo", "Linkwright provides no nodes of the package 'tf2_rs'", "did you mean 'tf2_ros'"),
        ("tf2_ros", "tf2_eco", "package 'tf2_ros' has no executable 'tf2_eco'", "did you mean 'tf2_echo'?"),
    ],
)
def test_unknown_package_and_executable_are_reported(capsys, package, executable, message, hint):
    assert main(package, executable, []) == 1
    error = capsys.readouterr().err
    assert message in error
    assert hint in error


def test_invalid_ros_arguments_are_rejected_before_start(capsys):
    assert main("demo_nodes_py", "talker", ["--ros-args", "--remapp", "a:=b"]) == 1
    assert "did you mean '--remap'?" in capsys.readouterr().err


@needs_network
def test_two_processes_communicate_over_dds(start_program):
    server = start_program("demo_nodes_py", "add_two_ints_server", "--ros-args", "-r", "add_two_ints:=/sum")
    client = start_program("demo_nodes_cpp", "add_two_ints_client", "--ros-args", "-r", "add_two_ints:=/sum")
    server.wait_for("Incoming request")
    client.wait_for("Result of add_two_ints: 5")
    assert client.process.wait(60) == 0
    client.end()
    assert server.end() == 0


@needs_network
def test_static_transform_reaches_tf2_echo(start_program):
    echo = start_program("tf2_ros", "tf2_echo", "map", "base", "10")
    publisher = start_program(
        *("tf2_ros", "static_transform_publisher", "--x", "1.5", "--frame-id", "map", "--child-frame-id", "base")
    )
    echo.wait_for("- Translation: [1.500, 0.000, 0.000]")
    assert echo.end(signal.SIGTERM) == 0
    assert publisher.end() == 0
