"""joy_teleop: buttons and axes of a joystick as messages, service calls and goals."""

from __future__ import annotations

import pytest

from linkwright.control.nodes.teleop.joy_teleop import JoyTeleop
from linkwright.graph import ActionServer
from linkwright.messages import get_action, get_message, get_service
from linkwright.nodes import NodeOptions

JOY, TWIST, STAMPED = (
    get_message(name) for name in ("sensor_msgs/Joy", "geometry_msgs/Twist", "geometry_msgs/TwistStamped")
)
STRING = get_message("std_msgs/String")
DRIVE = {
    "type": "topic",
    "interface_type": "geometry_msgs/msg/Twist",
    "topic_name": "cmd_vel",
    "deadman_buttons": [4],
    "axis_mappings": {
        "linear-x": {"axis": 1, "scale": 0.5, "offset": 0.1},
        "angular-z": {"button": 0, "scale": 2.0},
        "linear-y": {"value": 0.25},
    },
}


@pytest.fixture
async def joystick(harness):
    """Return a function that starts the node, and one that sends the state of the joystick."""
    publisher = harness.node.create_publisher(JOY, "joy", 10)
    nodes = []

    async def start(**commands):
        nodes.append(JoyTeleop(harness.graph, NodeOptions(parameters=commands)))
        await harness.graph.settle()

    async def press(*buttons, axes=(0.0, 0.0), count=6):
        publisher.publish(JOY(buttons=[int(number in buttons) for number in range(count)], axes=list(axes)))
        await harness.graph.settle()

    yield start, press
    for node in nodes:
        node.close()


def record(harness, message_type, topic):
    messages = []
    harness.node.create_subscription(message_type, topic, messages.append, 10)
    return messages


async def test_axes_are_forwarded_while_deadman_is_pressed(harness, joystick):
    start, press = joystick
    messages = record(harness, TWIST, "cmd_vel")
    await start(drive=DRIVE)
    await press(axes=(0.0, 1.0))
    assert not messages
    await press(4, axes=(0.0, 1.0))
    await press(4, 0, axes=(0.0, -1.0))
    assert [(m.linear.x, m.linear.y, m.angular.z) for m in messages] == [
        pytest.approx((0.6, 0.25, 0.0)),
        pytest.approx((-0.4, 0.25, 2.0)),
    ]


async def test_stamped_messages_have_the_time(harness, joystick):
    start, press = joystick
    messages = record(harness, STAMPED, "cmd_vel")
    mapping = {"twist-linear-x": {"axis": 1, "scale": 1.0, "offset": 0.0}}
    await start(drive={**DRIVE, "interface_type": "geometry_msgs/msg/TwistStamped", "axis_mappings": mapping})
    await harness.clock.advance(2.0)
    await press(4, axes=(0.0, 0.5))
    assert messages[0].twist.linear.x == 0.5
    now = harness.node.get_clock().now().to_msg()
    assert messages[0].header.stamp.sec == now.sec


async def test_fixed_message_is_sent_once_for_each_press(harness, joystick):
    start, press = joystick
    messages = record(harness, STRING, "speech")
    await start(
        greet={
            "type": "topic",
            "interface_type": "std_msgs/msg/String",
            "topic_name": "speech",
            "deadman_buttons": [1],
            "message_value": {"data": {"value": "hello"}},
        }
    )
    for buttons in ((1,), (1,), (), (1,)):
        await press(*buttons)
    assert [message.data for message in messages] == ["hello", "hello"]


async def test_command_without_buttons_is_active_while_none_is_pressed(harness, joystick):
    start, press = joystick
    messages = record(harness, TWIST, "cmd_vel")
    await start(drive={**DRIVE, "deadman_buttons": []})
    await press(2)
    assert not messages
    await press()
    assert len(messages) == 1


async def test_axis_at_its_end_activates_a_command(harness, joystick):
    start, press = joystick
    messages = record(harness, TWIST, "cmd_vel")
    await start(drive={**DRIVE, "deadman_buttons": [], "deadman_axes": [0]})
    await press(axes=(0.9, 0.0))
    assert not messages
    await press(axes=(1.0, 0.0))
    assert len(messages) == 1


async def test_service_is_called_once_and_when_its_server_appears(harness, joystick):
    start, press = joystick
    service, calls = get_service("std_srvs/SetBool"), []
    await start(
        lamp={
            "type": "service",
            "interface_type": "std_srvs/srv/SetBool",
            "service_name": "lamp",
            "service_request": {"data": True},
            "buttons": [2],
        }
    )
    await press(2)

    def serve(request, response):
        calls.append(request.data)
        return response

    harness.node.create_service(service, "lamp", serve)
    await harness.graph.settle()
    await press(2)
    await press(2)
    assert calls == [True]
    await press()
    await press(2)
    assert calls == [True, True]


async def test_goal_is_sent(harness, joystick):
    start, press = joystick
    action, goals = get_action("control_msgs/GripperCommand"), []

    def execute(handle):
        goals.append(handle.request.command.position)
        handle.succeed()
        return action.Result()

    server = ActionServer(harness.node, action, "gripper", execute)
    await start(
        grip={
            "type": "action",
            "interface_type": "control_msgs/action/GripperCommand",
            "action_name": "gripper",
            "action_goal": {"command": {"position": 0.04}},
            "buttons": [3],
        }
    )
    await press(3)
    await press(3)
    assert goals == [0.04]
    server.destroy()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"type": "button"}, "topic, service and action"),
        ({"topic_name": ""}, "'topic_name'"),
        ({"interface_type": "geometry_msgs/msg/Twisted"}, "Twisted"),
        ({"axis_mappings": {}}, "'axis_mappings'"),
        ({"axis_mappings": {"linear-x": {"scale": 1.0}}}, "'axis', 'button' or 'value'"),
        ({"axis_mappings": {"linear-x": {"axis": 1, "scale": 1.0}}}, "'offset'"),
        ({"axis_mappings": {"linear-w": {"value": 1.0}}}, "linear-w"),
    ],
)
async def test_invalid_command_is_logged_and_others_work(harness, joystick, log, changes, words):
    start, press = joystick
    messages = record(harness, TWIST, "cmd_vel")
    await start(broken={**DRIVE, **changes}, drive=DRIVE, use_sim_time=False)
    assert [record for record in log if words in str(record.text)]
    await press(4)
    assert len(messages) == 1


async def test_missing_axis_is_logged_once(harness, joystick, log):
    start, press = joystick
    messages = record(harness, TWIST, "cmd_vel")
    await start(drive=DRIVE)
    for _ in range(2):
        await press(4, axes=())
    assert [message.linear.x for message in messages] == [0.0, 0.0]
    assert len([record for record in log if "no axis 1" in str(record.text)]) == 1
