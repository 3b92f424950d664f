"""Programs that a script starts with ``&`` inherit an ignored SIGINT.

``kill -INT`` ends them, as it ends ROS's.
"""

from __future__ import annotations

import signal
import sys
from pathlib import Path

import pytest

from linkwright.bag import BagWriter
from linkwright.messages import String, serialize
from tests.domains import own_domain
from tests.reliability.running import Machine, RunningProcess, launch_file_text, program_text
from tests.waiting import wait_until

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the signal handlers of processes are read in /proc")

SPEAKING = """
class Program(Node):
    def __init__(self):
        super().__init__("speaker")
        say("speaks")
"""
COMMANDS = {
    "view": (("view", "r.urdf", "--no-open"), "Viewer:"),
    "sim": (("sim", "empty", "--headless"), "started in the launcher's process"),
    "run": (("run", "demo_nodes_cpp", "talker"), "Publishing"),
    "topic echo": (("topic", "echo", "/chatter", "std_msgs/msg/String"), ""),
    "topic pub": (("topic", "pub", "/chatter", "std_msgs/msg/String", "data: a"), "publishing #1"),
    "topic hz": (("topic", "hz", "/chatter"), "does not appear to be published yet"),
    "bag record": (("bag", "record", "-a", "-o", "recorded"), "Listening for topics"),
    "bag play": (("bag", "play", "--loop", "played"), ""),
    "service call": (("service", "call", "/nobody", "std_srvs/srv/Empty"), "waiting for service"),
    "doctor": (("doctor",), "observing the running graph"),
    "bridge": (("bridge", "dds:{domain}", "dds:{other}"), ""),
}


@pytest.fixture
def background(machine: Machine) -> Machine:
    """Start each process as a script does with ``&``."""
    machine.before = ("sh", "-c", 'trap "" INT; exec "$@"', "sh")
    return machine


def catches_interrupts(process: int) -> bool:
    """Return whether a process has a handler for SIGINT, according to Linux."""
    status = Path("/proc", str(process), "status").read_text(encoding="ascii")
    caught = next(line for line in status.splitlines() if line.startswith("SigCgt"))
    return bool(int(caught.split()[1], 16) & 1 << (signal.SIGINT - 1))


def interrupt_when_ready(running: RunningProcess, text: str) -> int:
    """Wait until a process handles SIGINT and has printed a text.

    Interrupt it, and return its exit status.
    """
    wait_until(lambda: catches_interrupts(running.process.pid), what=lambda: running.text)
    if text:
        running.wait_for(text)
    return running.interrupt()


@pytest.mark.slow
@pytest.mark.parametrize("name", COMMANDS)
def test_background_command_ends_on_sigint(background: Machine, name: str) -> None:
    words, text = COMMANDS[name]
    background.write("r.urdf", '<robot name="r"><link name="base"/></robot>')
    if name == "bag play":
        with BagWriter(background.folder / "played") as bag:
            bag.add_topic("/chatter", "std_msgs/msg/String")
            for second in range(2):
                bag.write("/chatter", second * 10**9, serialize(String(data="said")))
    domains = {"domain": own_domain(), "other": own_domain(1)}
    running = background.command(*(word.format_map(domains) for word in words))
    assert interrupt_when_ready(running, text) in (0, 130), running.text
    assert "Traceback" not in running.text


def test_background_user_node_ends_on_sigint(background: Machine) -> None:
    running = background.program(SPEAKING)
    assert interrupt_when_ready(running, "speaks") == 0, running.text


def test_process_in_background_launch_can_be_interrupted_alone(background: Machine) -> None:
    """A process of a background launch can be interrupted.

    It has the system's default for SIGINT, as in a terminal, however the launch was started.
    """
    path = background.write("speaker.py", program_text(SPEAKING))
    action = f"ExecuteProcess(cmd=[sys.executable, {str(path)!r}], output='screen')"
    running = background.launch(background.write("a.launch.py", launch_file_text(action)))
    running.wait_for("speaks")
    (child,) = [process for process in running.left_behind() if "speaker.py" in " ".join(process.cmdline())]
    child.send_signal(signal.SIGINT)
    assert running.wait() == 0, running.text
    assert "process has finished cleanly" in running.text
