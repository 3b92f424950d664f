"""The other processes after a process was killed with -9."""

from __future__ import annotations

import psutil

from tests.reliability.running import Machine, RunningProcess, launch_file_text, program_text
from tests.waiting import wait_until

TALKER = """
class Program(Node):
    def __init__(self):
        super().__init__("talker")
        self.publisher = self.create_publisher(Int32, "chatter", 10)
        self.number = 0
        self.create_timer(0.05, self.tick)
        say("up", __import__("os").getpid())

    def tick(self):
        self.number += 1
        self.publisher.publish(Int32(data=self.number))
"""
LISTENER = """
class Program(Node):
    def __init__(self):
        super().__init__("listener")
        self.count = 0
        self.create_subscription(Int32, "chatter", self.hear, 10)

    def hear(self, message):
        self.count += 1
        say("heard", message.data, self.count)
"""

# Each process has numbers of its own, which show who was heard.
MESSAGES_OF_A_TALKER = 1000
RESPAWNED_TALKER = TALKER.replace(
    "self.number = 0", f"self.number = __import__('os').getpid() % 2_000_000 * {MESSAGES_OF_A_TALKER}"
)


def test_killed_node_is_respawned_and_heard_again(machine: Machine) -> None:
    path = machine.write("talker.py", program_text(RESPAWNED_TALKER))
    launch = machine.launch(
        machine.write(
            "a.launch.py",
            launch_file_text(f"ExecuteProcess(cmd=[sys.executable, {str(path)!r}], name='talker', respawn=True)"),
        )
    )
    listener = machine.program(LISTENER)
    listener.wait_for("heard", times=3)
    for round_number in (1, 2):
        (victim,) = [process for process in launch.left_behind() if str(path) in " ".join(_words(process))]
        victim.kill()
        launch.wait_for("has died", times=round_number)
        launch.wait_for("process started with pid", times=round_number + 1)
        _wait_for_talkers(listener, round_number + 1)
        listener.wait_for("heard", times=listener.count("heard") + 6)
        # The killed node is not listed, although its lease of five seconds has not expired.
        assert machine.verb("node", "list").split() == ["/listener", "/talker"]
    assert launch.interrupt() == 130
    wait_until(lambda: not launch.left_behind())
    wait_until(lambda: machine.verb("node", "list").split() == ["/listener"])


def _wait_for_talkers(listener: RunningProcess, count: int) -> None:
    """Wait until the listener has heard a number of talkers, one after the other."""

    def has_heard_all() -> bool:
        numbers = [int(line.split()[1]) for line in tuple(listener.lines) if line.startswith("heard")]
        return len({number // MESSAGES_OF_A_TALKER for number in numbers}) == count

    wait_until(has_heard_all, what=lambda: listener.text)


def _words(process: psutil.Process) -> list[str]:
    try:
        return process.cmdline()
    except psutil.Error:
        return []


def test_subscriber_survives_killed_publisher(machine: Machine) -> None:
    listener = machine.program(LISTENER)
    for _ in range(3):
        before = listener.count("heard")
        talker = machine.program(TALKER)
        listener.wait_for("heard", times=before + 3)
        talker.kill()
    assert listener.process.poll() is None
    assert listener.interrupt() == 0
    assert "Traceback" not in listener.text


def test_publisher_survives_killed_subscriber(machine: Machine) -> None:
    talker = machine.program(TALKER)
    for _ in range(3):
        listener = machine.program(LISTENER)
        listener.wait_for("heard", times=3)
        listener.kill()
    listener = machine.program(LISTENER)
    listener.wait_for("heard", times=10)
    numbers = [int(line.split()[1]) for line in listener.lines if line.startswith("heard")]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))
    assert talker.interrupt() == 0
    assert "Traceback" not in talker.text


def test_killed_launch_leaves_no_processes_or_nodes(machine: Machine) -> None:
    path = machine.write("talker.py", program_text(TALKER))
    launch = machine.launch(
        machine.write(
            "a.launch.py",
            launch_file_text(
                f"ExecuteProcess(cmd=[sys.executable, {str(path)!r}], respawn=True, output='screen')",
                "Node(package='demo_nodes_cpp', executable='listener')",
            ),
        )
    )
    launch.wait_for("up ")
    assert len(launch.left_behind()) >= 2
    launch.kill()
    wait_until(lambda: not launch.left_behind(), what=launch.left_behind)
    wait_until(lambda: machine.verb("node", "list").split() == [])
