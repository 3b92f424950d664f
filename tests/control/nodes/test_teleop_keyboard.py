"""teleop_twist_keyboard in a terminal of the test."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Iterator

import pytest

from linkwright.control.nodes.teleop.keyboard import TeleopTwistKeyboard
from linkwright.control.nodes.teleop.keys import split_keys
from linkwright.diagnostics import LinkwrightError
from linkwright.nodes import NodeOptions
from tests.waiting import TIMEOUT_S, eventually

if sys.platform == "win32":
    pytest.skip("Windows has no pseudo-terminals", allow_module_level=True)

import termios

TWIST, TWIST_STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"


def is_echoing(descriptor: int) -> bool:
    return bool(termios.tcgetattr(descriptor)[3] & termios.ECHO)


@pytest.fixture
def terminal() -> Iterator[tuple[int, int]]:
    """Return both ends of a pseudo-terminal: the typing side, and the program's side."""
    sides = os.openpty()
    yield sides
    for side in sides:
        with contextlib.suppress(OSError):  # the test closed it
            os.close(side)


class Driver:
    """A typing user, with the published velocities and the printed text."""

    def __init__(self, harness, typing_end, program_end, kind=TWIST, **parameters):
        self.harness, self.typing_end, self.program_end = harness, typing_end, program_end
        self.messages, self.printed = [], []
        self.closed = False
        if kind:
            harness.node.create_subscription(kind, "/cmd_vel", self.messages.append, 10)
        options = NodeOptions(parameters=parameters, output=self.printed.append, terminal=program_end)
        self.node = TeleopTwistKeyboard(harness.graph, options)

    async def type(self, text, messages):
        """Press keys, wait for a number of messages, and return the last as x, y, z, yaw rate."""
        os.write(self.typing_end, text.encode())
        await eventually(lambda: len(self.messages) >= messages, what=lambda: self.messages)
        assert len(self.messages) == messages
        return self.last()

    def close(self):
        self.closed = True
        self.node.close()

    def last(self):
        twist = getattr(self.messages[-1], "twist", self.messages[-1])
        return twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.z


@pytest.fixture
def start_driver(harness, terminal):
    drivers = []

    def start_driver(**options):
        drivers.append(Driver(harness, *terminal, **options))
        return drivers[-1]

    yield start_driver
    for driver in drivers:
        if not driver.closed:
            driver.close()


async def test_keys_match_teleop_twist_keyboard(start_driver):
    driver = start_driver()
    forwards = {"i": (0.5, 0, 0, 0), "o": (0.5, 0, 0, -1), "u": (0.5, 0, 0, 1), "j": (0, 0, 0, 1), "l": (0, 0, 0, -1)}
    backwards = {",": (-0.5, 0, 0, 0), ".": (-0.5, 0, 0, 1), "m": (-0.5, 0, 0, -1), "k": (0, 0, 0, 0)}
    sideways = {"I": (0.5, 0, 0, 0), "O": (0.5, -0.5, 0, 0), "U": (0.5, 0.5, 0, 0), "J": (0, 0.5, 0, 0)}
    shifted_keys = {"L": (0, -0.5, 0, 0), "<": (-0.5, 0, 0, 0), ">": (-0.5, -0.5, 0, 0), "M": (-0.5, 0.5, 0, 0)}
    heights = {"t": (0, 0, 0.5, 0), "b": (0, 0, -0.5, 0), "K": (0, 0, 0, 0)}
    expected = forwards | backwards | sideways | shifted_keys | heights
    for count, (key, velocity) in enumerate(expected.items(), 1):
        assert await driver.type(key, count) == velocity, key


async def test_speed_keys_change_by_ten_percent_and_print_speed(start_driver):
    driver = start_driver(speed=0.2, turn=2.0)
    assert "u    i    o" in driver.printed[0]
    assert driver.printed[1] == "currently:\tspeed 0.2\tturn 2.0 "
    await driver.type("i", 1)
    assert (await driver.type("w", 2))[0] == pytest.approx(0.22)
    await driver.type("c", 3)
    assert driver.printed[-1] == f"currently:\tspeed {0.2 * 1.1}\tturn 1.8 "
    await driver.type("q", 4)
    for count in range(5, 18):
        await driver.type("z", count)
    assert sum("u    i    o" in line for line in driver.printed) == 2, "the help is printed again after fifteen changes"


async def test_arrow_keys_stop_robot(start_driver):
    driver = start_driver()
    await driver.type("i", 1)
    assert await driver.type("\x1bOC", 2) == (0, 0, 0, 0)
    assert list(split_keys("\x1b[1;5Ai\x1b")) == ["\x1b[1;5A", "i", "\x1b"]


async def test_message_type_matches_subscriber(start_driver, harness):
    driver = start_driver(kind=TWIST_STAMPED, frame_id="base_link")
    await driver.type("i", 1)
    assert driver.messages[0].header.frame_id == "base_link"
    assert driver.messages[0].header.stamp.sec == harness.clock.now_ns() // 10**9


async def test_message_type_follows_late_subscriber(start_driver, harness):
    driver = start_driver(kind=None)
    harness.node.create_subscription(TWIST_STAMPED, "/cmd_vel", driver.messages.append, 10)
    await harness.clock.advance(0.6)
    await driver.type("i", 1)


@pytest.mark.parametrize(("stamped", "kind"), [(True, TWIST_STAMPED), (False, TWIST)])
async def test_message_type_matches_stamped_parameter(start_driver, harness, stamped, kind):
    start_driver(kind=None, stamped=stamped)
    assert [endpoint.type_name for endpoint in harness.graph.endpoints() if endpoint.name == "/cmd_vel"] == [kind]


async def test_key_timeout_stops_robot(start_driver, harness):
    driver = start_driver(key_timeout=0.6)
    await driver.type("i", 1)
    await harness.clock.advance(0.5)
    await driver.type("i", 2)
    await harness.clock.advance(0.5)
    assert len(driver.messages) == 2
    await harness.clock.advance(0.2)
    assert driver.last() == (0, 0, 0, 0)
    await harness.clock.advance(5.0)
    assert len(driver.messages) == 3, "the robot is stopped only once"


async def test_repeat_rate_republishes_velocity(start_driver, harness):
    driver = start_driver(repeat_rate=10.0)
    await driver.type("u", 1)
    await harness.clock.advance(1.05)
    assert len(driver.messages) == 11
    assert driver.last() == (0.5, 0, 0, 1)


async def test_missing_subscriber_is_reported_once(start_driver, harness, logged):
    driver = start_driver(kind=None)
    os.write(driver.typing_end, b"i")
    await eventually(lambda: driver.node._direction.x == 1.0)
    await harness.clock.advance(3.0)
    assert logged("WARN") == ["no node subscribes to /cmd_vel; run `linkwright doctor` for details"]


@pytest.mark.parametrize("end", ["\x03", "closed"])
async def test_exit_stops_robot_and_restores_terminal(start_driver, end):
    driver = start_driver()
    assert not is_echoing(driver.program_end)
    await driver.type("i", 1)
    if end == "closed":
        os.close(driver.typing_end)
    else:
        settings = termios.tcgetattr(driver.program_end)
        settings[3] &= ~termios.ISIG
        termios.tcsetattr(driver.program_end, termios.TCSANOW, settings)
        os.write(driver.typing_end, end.encode())
    await eventually(driver.node.finished.done)
    assert driver.node.finished.result() == 0
    await driver.harness.graph.settle()
    assert driver.last() == (0, 0, 0, 0)
    assert end == "closed" or is_echoing(driver.program_end)


async def test_closing_node_stops_robot(start_driver):
    driver = start_driver()
    await driver.type("i", 1)
    driver.close()
    await driver.harness.graph.settle()
    assert driver.last() == (0, 0, 0, 0)
    assert is_echoing(driver.program_end)


async def test_missing_terminal_is_reported(harness):
    with pytest.raises(LinkwrightError) as error:
        TeleopTwistKeyboard(harness.graph, NodeOptions())
    assert [diagnostic.code for diagnostic in error.value.diagnostics] == ["NODE901"]
    assert harness.graph.topics().get("/cmd_vel") is None


async def test_negative_speed_is_rejected(harness):
    with pytest.raises(LinkwrightError) as error:
        TeleopTwistKeyboard(harness.graph, NodeOptions(parameters={"speed": -1.0}))
    assert [diagnostic.code for diagnostic in error.value.diagnostics] == ["NODE902"]


@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, None], ids=str)
def test_process_restores_terminal(terminal, tmp_path, end):
    typing_end, program_end = terminal
    process = subprocess.Popen(
        [sys.executable, "-m", "linkwright.node_program", "teleop_twist_keyboard", "teleop_twist_keyboard"],
        env={**os.environ, "LINKWRIGHT_DDS": "0", "ROS_LOG_DIR": str(tmp_path)},
        stdin=program_end,
        stdout=program_end,
        stderr=subprocess.PIPE,
    )
    try:
        output = b""
        while b"currently:" not in output or not output.endswith(b"\n"):
            output += os.read(typing_end, 4096)
        assert not is_echoing(program_end)
        if end is None:
            os.close(typing_end)
        else:
            process.send_signal(end)
        assert process.stderr is not None
        assert process.stderr.read() == b""
        assert process.wait(TIMEOUT_S) == 0
        assert end is None or is_echoing(program_end)
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()
        assert process.stderr is not None
        process.stderr.close()
