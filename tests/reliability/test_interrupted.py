"""Ctrl-C at every moment.

The program ends at once with the right status, and leaves nothing behind.
"""

from __future__ import annotations

import os
import pty
import random
import re
import subprocess
import sys
import termios
import threading
import time
from contextlib import suppress

import psutil
import pytest

from tests.begun import BEGUN, command_that_reports
from tests.reliability.running import PROCESS_MARK, Machine, launch_file_text, program_text
from tests.waiting import TIMEOUT_S, wait_until

TALKER = """
class Program(Node):
    def __init__(self):
        super().__init__("talker")
        self.number = 0
        self.publisher = self.create_publisher(Int32, "chatter", 10)
        self.create_timer(0.02, self.tick)

    def tick(self):
        self.number += 1
        self.publisher.publish(Int32(data=self.number))
"""
LISTENER = """
class Program(Node):
    def __init__(self):
        super().__init__("listener")
        self.create_subscription(Int32, "chatter", lambda message: say("heard", message.data), 10)
"""
OWN_TERMINAL = """
import fcntl, os, sys, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
os.execv(sys.argv[1], sys.argv[1:])
"""


def find_traceback(text: str) -> bool:
    return re.search(r"^(\[\S+\] )?Traceback", text, re.MULTILINE) is not None


@pytest.mark.slow
def test_launch_interrupted_at_random_startup_moments_ends_cleanly(machine: Machine) -> None:
    path = machine.write("talker.py", program_text(TALKER))
    launch = machine.write(
        "a.launch.py",
        launch_file_text(
            "Node(package='demo_nodes_cpp', executable='talker')",
            "Node(package='rviz2', executable='rviz2')",
            f"ExecuteProcess(cmd=[sys.executable, {str(path)!r}], respawn=True, output='screen')",
        ),
    )
    for delay in sorted(random.Random(11).uniform(0.0, 1.5) for _ in range(20)):
        running = machine.start_handling_interrupts("launch", launch, "--no-open")
        time.sleep(delay)
        status = running.interrupt()
        failure_text = f"interrupted after {delay:.3f} s, status {status}:\n{running.text}"
        assert status == 130, failure_text
        assert not re.search(r"^Traceback", running.text, re.MULTILINE), failure_text
        wait_until(lambda running=running: not running.left_behind(), what=failure_text)


@pytest.mark.slow
@pytest.mark.parametrize("delay", [0.1, 0.2, 0.35, 0.6, 1.2])
def test_interrupt_restores_terminal_settings(machine: Machine, delay: float) -> None:
    """Ctrl-C restores the settings of a terminal.

    It is typed in the terminal of a launch, and in the terminal of a recording, which reads keys.
    """
    path = machine.write("a.launch.py", launch_file_text("Node(package='demo_nodes_cpp', executable='talker')"))
    bag = machine.folder / f"bag_{delay}"
    for words in (["launch", str(path)], ["bag", "record", "-a", "-o", str(bag)]):
        main, terminal = pty.openpty()
        before = termios.tcgetattr(terminal)
        process = subprocess.Popen(
            [sys.executable, "-c", OWN_TERMINAL, *command_that_reports("linkwright", *words)],
            stdin=terminal,
            stdout=terminal,
            stderr=terminal,
            env={**os.environ, **machine.variables, PROCESS_MARK: "terminal"},
            cwd=machine.folder,
            start_new_session=True,
        )
        chunks: list[bytes] = []
        reader = threading.Thread(target=_drain, args=(main, chunks), daemon=True)
        reader.start()
        try:
            # Before the process is in the foreground, no process receives the Ctrl-C.
            wait_until(lambda main=main, process=process: os.tcgetpgrp(main) == process.pid)
            wait_until(lambda heard=chunks: BEGUN.encode() in b"".join(heard))
            time.sleep(delay)
            os.write(main, b"\x03")
            status = process.wait(TIMEOUT_S)
        finally:
            process.kill()
        text = b"".join(chunks).decode(errors="replace")
        assert status in (130, 0), text
        after = termios.tcgetattr(terminal)
        assert after[:4] == before[:4], text
        os.close(terminal)
        reader.join(60.0)
        os.close(main)


FIRST_MODULES = {
    "linkwright",
    "linkwright._version",
    "linkwright.cli",
    "linkwright.cli.entry",
    "linkwright.cli.tools",
    "linkwright.process",
    "linkwright.process.interruption",
}
"""The modules that are loaded before Ctrl-C is handled, in about a millisecond."""

WATCHED = """
import runpy, sys
from linkwright.process import interruption
def watch():
    print(*(module for module in sys.modules if module.partition(".")[0] == "linkwright"))
    raise SystemExit
interruption.end_on_interrupt = watch
sys.argv[:] = sys.argv[1:]
runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
"""

COMMANDS = [
    ("linkwright", "topic", "echo", "/nobody", "std_msgs/msg/String"),
    ("linkwright", "run", "demo_nodes_cpp", "talker"),
    ("linkwright", "launch", "a.launch.py"),
    ("linkwright.cli.tools", "ros2", "topic", "echo", "/nobody", "std_msgs/msg/String"),
    ("linkwright.node_program", "demo_nodes_cpp", "talker"),
]


@pytest.mark.parametrize("words", COMMANDS)
def test_few_modules_are_imported_before_sigint_handler(machine: Machine, words: tuple[str, ...]) -> None:
    running = machine.python("-c", WATCHED, *words)
    assert running.wait() == 0, running.text
    assert {"linkwright", "linkwright.process.interruption"} <= set(running.text.split()) <= FIRST_MODULES


@pytest.mark.parametrize("words", COMMANDS)
def test_interrupt_during_imports_prints_no_traceback(machine: Machine, words: tuple[str, ...]) -> None:
    machine.write("a.launch.py", launch_file_text("Node(package='demo_nodes_cpp', executable='talker')"))
    for delay in (0.0, 0.01, 0.025, 0.04, 0.06, 0.09, 0.13, 0.18, 0.25):
        running = machine.start_handling_interrupts(*words[1:], module=words[0])
        time.sleep(delay)
        status = running.interrupt()
        # A running node ends with status 0, as all nodes do.
        assert status in ((0, 130) if "talker" in words else (130,)), running.text
        assert not find_traceback(running.text), running.text


def _drain(main: int, chunks: list[bytes]) -> None:
    with suppress(OSError):
        while data := os.read(main, 4096):
            chunks.append(data)


@pytest.mark.parametrize(
    ("words", "shown"),
    [
        (("topic", "echo", "/chatter", "std_msgs/msg/Int32"), "data:"),  # without a type, it needs a publisher
        (("topic", "hz", "/chatter"), "average rate"),
        (("topic", "bw", "/chatter"), "from"),
        (("topic", "pub", "/words", "std_msgs/msg/String", "{data: hi}"), "publishing #"),
        (("topic", "echo", "/nobody", "std_msgs/msg/String"), ""),
        (("run", "demo_nodes_cpp", "listener"), ""),
    ],
)
def test_running_command_ends_on_interrupt(machine: Machine, words: tuple[str, ...], shown: str) -> None:
    machine.program(TALKER)
    running = machine.command(*words)
    if shown:
        running.wait_for(shown)
    else:
        wait_until(lambda: psutil.Process(running.process.pid).net_connections("udp"))
    status = running.interrupt()
    assert status in (0, 130), running.text
    assert not find_traceback(running.text), running.text


@pytest.mark.slow
def test_topic_echo_interrupted_during_startup_exits_with_130(machine: Machine) -> None:
    machine.program(TALKER)
    for delay in sorted(random.Random(5).uniform(0.0, 0.9) for _ in range(10)):
        # With a type, the command waits for a slow talker.
        running = machine.start_handling_interrupts("topic", "echo", "/chatter", "std_msgs/msg/Int32")
        time.sleep(delay)
        status = running.interrupt()
        failure_text = f"interrupted after {delay:.3f} s, status {status}:\n{running.text}"
        assert status == 130, failure_text
        assert not find_traceback(running.text), failure_text


def test_interrupted_recording_is_complete(machine: Machine) -> None:
    machine.program(TALKER)
    bag = machine.folder / "bag"
    recorder = machine.command("bag", "record", "/chatter", "-o", bag)
    wait_until(lambda: sum(path.stat().st_size for path in bag.glob("*")) > 100 if bag.is_dir() else False)
    recorder.wait_for("Subscribed to topic '/chatter'")
    listener = machine.program(LISTENER)
    listener.wait_for("heard", times=60)  # the recorder receives these messages too
    status = recorder.interrupt()
    assert status in (0, 130), recorder.text
    info = machine.verb("bag", "info", bag)
    match = re.search(r"Topic: /chatter .*Count: (\d+)", info)
    assert match, info
    assert int(match[1]) >= 40, info
    from rosbags.highlevel import AnyReader  # like DDS, it has no wheel for Python 3.15
    from rosbags.typesys import Stores, get_typestore

    with AnyReader([bag], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        numbers = [reader.deserialize(data, connection.msgtype).data for connection, _, data in reader.messages()]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))


def test_interrupt_during_service_call_ends_client_and_server(machine: Machine) -> None:
    """The waiting client ends at once; the server continues, and ends when it is interrupted."""
    leave = machine.folder / "leave"
    server = machine.program(
        """
        import os
        from std_srvs.srv import Trigger

        class Program(Node):
            def __init__(self):
                super().__init__("server")
                self.create_service(Trigger, "slow", self.answer)
                say("up")

            def answer(self, request, response):
                say("asked")
                while not os.path.exists("leave"):
                    time.sleep(0.01)
                say("answered")
                return response
        """
    )
    server.wait_for("up")
    client = machine.command("service", "call", "/slow", "std_srvs/srv/Trigger")
    server.wait_for("asked")
    assert client.interrupt() == 130, client.text
    assert not find_traceback(client.text), client.text
    leave.touch()
    server.wait_for("answered")
    assert "response" in machine.verb("service", "call", "/slow", "std_srvs/srv/Trigger")
    leave.unlink()
    second = machine.command("service", "call", "/slow", "std_srvs/srv/Trigger")
    server.wait_for("asked", times=3)
    server.interrupt()
    assert not find_traceback(server.text), server.text
    second.interrupt()
