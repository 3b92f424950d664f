"""Joysticks: a pipe with the kernel's events, and the messages of the nodes."""

from __future__ import annotations

import os
import struct
import sys

import pytest

from linkwright.control.nodes.teleop.joy import JoyLinuxNode, JoyNode, compute_deflection
from linkwright.control.nodes.teleop.twist_joy import TeleopTwistJoy
from linkwright.diagnostics import LinkwrightError
from linkwright.messages import get_message
from linkwright.nodes import NodeOptions
from tests.waiting import eventually

JOY = get_message("sensor_msgs/msg/Joy")
BUTTON, AXIS, INITIAL = 1, 2, 0x80

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the joystick is a named pipe")


class Joystick:
    """A fake device at a path of the test."""

    def __init__(self, path):
        self.path = path
        self.file = None

    def plug_in(self):
        os.mkfifo(self.path)
        # A pipe that is opened for reading and writing is ready for its reader at once.
        self.file = os.open(self.path, os.O_RDWR)

    def pull_out(self):
        self.path.unlink()
        self.file = os.close(self.file)

    def send(self, *events):
        """Send events, each as kind, number and value."""
        for kind, number, value in events:
            os.write(self.file, struct.pack("=IhBB", 0, value, kind, number))


@pytest.fixture
def joystick(tmp_path, monkeypatch):
    monkeypatch.setattr("linkwright.control.nodes.teleop.joystick_device.DEVICE_FOLDER", tmp_path)
    joystick = Joystick(tmp_path / "js0")
    yield joystick
    if joystick.file is not None:
        os.close(joystick.file)


@pytest.fixture
def joy_messages(harness):
    messages = []
    harness.node.create_subscription(JOY, "/joy", messages.append, 100)
    return messages


@pytest.fixture
async def start_node(harness):
    nodes = []

    def start_node(kind=JoyNode, **parameters):
        nodes.append(kind(harness.graph, NodeOptions(parameters=parameters)))
        return nodes[-1]

    yield start_node
    for joy_node in nodes:
        joy_node.close()


async def test_axes_and_buttons_match_ros(joystick, harness, joy_messages, start_node):
    joystick.plug_in()
    joystick.send((AXIS | INITIAL, 0, 0), (AXIS | INITIAL, 1, 0), (BUTTON | INITIAL, 0, 0), (BUTTON | INITIAL, 1, 0))
    node = start_node(deadzone=0.2, autorepeat_rate=0.0)
    await eventually(lambda: len(node._buttons) == 2)
    await harness.clock.advance(0.01)
    assert [(list(message.axes), list(message.buttons)) for message in joy_messages] == [([0, 0], [0, 0])], (
        "the initial events are one message"
    )
    joystick.send((BUTTON, 1, 1))
    await eventually(lambda: len(joy_messages) == 2)
    assert list(joy_messages[-1].buttons) == [0, 1]
    assert joy_messages[-1].header.frame_id == "joy"
    joystick.send((AXIS, 1, -32767), (AXIS, 0, 19661))
    await eventually(lambda: node._axes[0] != 0)
    await harness.clock.advance(0.01)
    assert list(joy_messages[-1].axes) == pytest.approx([-0.5, 1.0], abs=1e-4)
    assert len(joy_messages) == 3, "events within a millisecond are one message"


def test_deadzone_is_continuous():
    assert [round(compute_deflection(value, 0.1), 4) for value in (0, 3276, -3277, -32767, 32767, -32768)] == [
        0,
        0,
        0,
        1,
        -1,
        1,
    ]
    assert compute_deflection(-18022, 0.1) == pytest.approx(0.5, abs=1e-4)


async def test_unchanged_state_is_republished_at_autorepeat_rate(joystick, harness, joy_messages, start_node):
    joystick.plug_in()
    joystick.send((AXIS | INITIAL, 0, 0))
    node = start_node(autorepeat_rate=10.0)
    await eventually(lambda: len(node._axes) == 1)
    await harness.clock.advance(1.005)
    assert len(joy_messages) == 11


async def test_sticky_buttons_toggle(joystick, harness, joy_messages, start_node):
    joystick.plug_in()
    start_node(sticky_buttons=True, autorepeat_rate=0.0)
    for count, value in enumerate((1, 0, 1), 1):
        joystick.send((BUTTON, 0, value))
        if value:
            await eventually(lambda expected=(count + 1) // 2: len(joy_messages) == expected)
    assert [list(message.buttons) for message in joy_messages] == [[1], [0]]


async def test_missing_joystick_is_reported_once(joystick, harness, joy_messages, start_node, logged):
    node = start_node(autorepeat_rate=0.0)
    await harness.clock.advance(5.0)
    assert logged("WARN") == ["the joystick /dev/input/js0 is not connected; waiting for it"]
    joystick.plug_in()
    joystick.send((BUTTON | INITIAL, 0, 1))
    await harness.clock.advance(1.0)
    await eventually(lambda: node._buttons == [1])
    await harness.clock.advance(0.01)
    assert list(joy_messages[-1].buttons) == [1]


async def test_disconnected_joystick_releases_axes_and_buttons(joystick, harness, joy_messages, start_node, logged):
    joystick.plug_in()
    start_node(autorepeat_rate=0.0)
    joystick.send((BUTTON, 0, 1), (AXIS, 0, 32767))
    await eventually(lambda: joy_messages and list(joy_messages[-1].axes))
    joystick.pull_out()
    await eventually(lambda: "the joystick was disconnected; waiting for it" in logged("WARN"))
    await harness.graph.settle()
    assert (list(joy_messages[-1].axes), list(joy_messages[-1].buttons)) == ([0.0], [0])
    joystick.plug_in()
    await harness.clock.advance(1.0)
    joystick.send((BUTTON, 2, 1))
    await eventually(lambda: list(joy_messages[-1].buttons) == [0, 0, 1])


async def test_unreadable_joystick_is_reported(tmp_path, harness, start_node, logged):
    start_node(JoyLinuxNode, dev=str(tmp_path))  # a folder is not a joystick
    (text,) = logged("WARN")
    assert text.startswith(f"the joystick {tmp_path} cannot be read: ")


async def test_joy_linux_accepts_device_path(tmp_path, harness, joy_messages, start_node):
    joystick = Joystick(tmp_path / "mine")
    joystick.plug_in()
    start_node(JoyLinuxNode, dev=str(joystick.path), coalesce_interval=0.0, autorepeat_rate=0.0)
    joystick.send((AXIS, 0, -32767))
    await eventually(lambda: joy_messages)
    assert list(joy_messages[0].axes) == [1.0]
    os.close(joystick.file)


@pytest.mark.parametrize(
    "invalid_parameters", [{"deadzone": 1.5}, {"autorepeat_rate": -1.0}, {"coalesce_interval_ms": -1}]
)
async def test_out_of_range_parameters_are_rejected(harness, invalid_parameters):
    with pytest.raises(LinkwrightError) as error:
        JoyNode(harness.graph, NodeOptions(parameters=invalid_parameters))
    assert error.value.diagnostics[0].code == "NODE903"
    assert next(iter(invalid_parameters)) in error.value.diagnostics[0].message


# --- teleop_twist_joy -----------------------------------------------------------------------------------------------


class Pilot:
    """Publisher of Joy messages, with the velocities of the teleop node."""

    def __init__(self, harness, kind="geometry_msgs/msg/Twist"):
        self.harness = harness
        self.node = harness.graph.create_node("joystick")
        self.publisher = self.node.create_publisher(JOY, "/joy", 10)
        self.velocities = []
        harness.node.create_subscription(kind, "/cmd_vel", self.velocities.append, 10)

    async def hold(self, axes, *buttons):
        """Deflect axes and press buttons; return the following velocity, or None."""
        self.velocities.clear()
        self.publisher.publish(JOY(axes=axes, buttons=[int(number in buttons) for number in range(8)]))
        await self.harness.graph.settle()
        if not self.velocities:
            return None
        twist = getattr(self.velocities[-1], "twist", self.velocities[-1])
        return twist.linear.x, twist.linear.y, twist.angular.z


AXES = [0.5, 0.25, 1.0, 0.0, 0.0, 1.0]


async def test_enable_button_must_be_held(harness, start_node):
    pilot = Pilot(harness)
    start_node(TeleopTwistJoy)
    assert await pilot.hold(AXES) is None
    assert await pilot.hold(AXES, 5) == (0.5, 0, 0.5)
    assert await pilot.hold(AXES) == (0, 0, 0)
    assert await pilot.hold(AXES) is None, "the robot is stopped only once"


async def test_turbo_scales_and_additional_axes(harness, start_node):
    pilot = Pilot(harness)
    start_node(
        TeleopTwistJoy,
        **{"enable_turbo_button": 7, "axis_linear.x": 1, "axis_linear.y": 0, "scale_linear.y": 2.0},
        **{"scale_linear_turbo.x": 4.0, "axis_angular.yaw": 17},
    )
    assert await pilot.hold(AXES, 5) == (0.125, 1.0, 0)
    assert await pilot.hold(AXES, 7) == (1.0, 0, 0)


async def test_inverted_reverse_and_optional_enable_button(harness, start_node):
    pilot = Pilot(harness)
    start_node(TeleopTwistJoy, inverted_reverse=True, require_enable_button=False)
    assert await pilot.hold([0, 0, 1.0, 0, 0, -1.0]) == (-0.5, 0, -0.5)


async def test_parameters_can_be_changed(harness, start_node):
    pilot = Pilot(harness)
    node = start_node(TeleopTwistJoy)
    assert await harness.set(node, enable_button=1) == [(True, "")]
    assert await pilot.hold(AXES, 1) == (0.5, 0, 0.5)


async def test_message_type_matches_subscriber(harness, start_node):
    pilot = Pilot(harness, "geometry_msgs/msg/TwistStamped")
    start_node(TeleopTwistJoy, frame="base_link")
    assert await pilot.hold(AXES, 5) == (0.5, 0, 0.5)
    assert pilot.velocities[0].header.frame_id == "base_link"


async def test_lost_joy_publisher_stops_robot(harness, start_node, logged):
    pilot = Pilot(harness)
    start_node(TeleopTwistJoy)
    await pilot.hold(AXES, 5)
    pilot.velocities.clear()
    pilot.node.destroy_node()
    await harness.clock.advance(1.0)
    assert [twist.linear.x for twist in pilot.velocities] == [0.0]
    assert logged("WARN") == ["'/joy' no longer has a publisher, so the robot is stopped"]


async def test_closing_node_stops_robot(harness):
    pilot = Pilot(harness)
    node = TeleopTwistJoy(harness.graph, NodeOptions())
    await pilot.hold(AXES, 5)
    pilot.velocities.clear()
    node.close()
    await harness.graph.settle()
    assert [twist.linear.x for twist in pilot.velocities] == [0.0]
