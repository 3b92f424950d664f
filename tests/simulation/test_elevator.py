"""An elevator with two floors more than its ground floor, and with doors."""

from __future__ import annotations

from functools import partial

import pytest

from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS
from tests.simulation.test_plugins import running_server as any_running_server

running_server = partial(any_running_server, step=0.01)
FLOOR_HEIGHTS = (0.0, 3.0, 6.0)
INTEGER = "std_msgs/msg/Int32"


def _sliding(link: str, joint: str, axis: str, upper: float, pose: str) -> str:
    """Return a link on a prismatic joint with a position controller."""
    return (
        f'<link name="{link}"><pose>{pose}</pose><inertial><mass>10</mass></inertial></link>'
        f'<joint name="{joint}" type="prismatic"><parent>frame</parent><child>{link}</child><axis><xyz>{axis}</xyz>'
        f"<limit><lower>0</lower><upper>{upper}</upper><velocity>2</velocity></limit></axis></joint>"
        f'<plugin name="{joint}" filename="gz-sim-joint-position-controller-system"><joint_name>{joint}</joint_name>'
        "<use_velocity_commands>true</use_velocity_commands></plugin>"
    )


def elevator_model(parameters: str = "<open_door_wait_duration>1</open_door_wait_duration>") -> str:
    floors = "".join(
        f'<link name="floor_{number}"><pose>2 0 {height} 0 0 0</pose></link><joint name="slab_{number}" type="fixed">'
        f"<parent>frame</parent><child>floor_{number}</child></joint>"
        + _sliding(f"door_link_{number}", f"door_{number}", "0 1 0", 1.0, f"1 0 {height} 0 0 0")
        for number, height in enumerate(FLOOR_HEIGHTS)
    )
    plugin = f'<plugin name="gz::sim::systems::Elevator" filename="gz-sim-elevator-system">{parameters}</plugin>'
    return (
        '<model name="tower"><pose>0 0 1 0 0 0</pose><link name="frame"/><joint name="base" type="fixed">'
        f"<parent>world</parent><child>frame</child></joint>{_sliding('cabin', 'lift', '0 0 1', 6.0, '0 0 0 0 0 0')}"
        f"{floors}{plugin}</model>"
    )


async def command_floors(server, graph, *floors: int, topic: str = "/model/tower/cmd") -> None:
    """Command floors."""
    publisher = graph.create_node("passenger").create_publisher(INTEGER, topic, 10)
    for floor in floors:
        publisher.publish(get_message(INTEGER)(data=floor))
    await graph.settle()


def elevator_state(server) -> tuple[float, ...]:
    """Return the rounded positions of the cabin and of the three doors."""
    joints = ("lift", "door_0", "door_1", "door_2")
    return tuple(round(server.simulation.joint_state(f"tower::{joint}")[0], 1) + 0.0 for joint in joints)


async def advance_in_steps(server, graph, seconds: float) -> None:
    """Advance the time in steps, between which messages are delivered."""
    for _ in range(round(seconds * 10)):
        server.advance(SECOND_NS // 10)
        await graph.settle()


async def visited_floors(server, graph, seconds: float) -> list[int]:
    """Return the floors whose doors open within a time, in order."""
    visited: list[int] = []
    for _ in range(round(seconds * 10)):
        await advance_in_steps(server, graph, 0.1)
        for number, position in enumerate(elevator_state(server)[1:]):
            if position == 1.0 and (not visited or visited[-1] != number):
                visited.append(number)
    return visited


async def test_elevator_moves_opens_waits_and_closes():
    async with running_server(elevator_model()) as (server, graph, log):
        recording = Recording(graph, server.node, "/model/tower/state")
        await command_floors(server, graph, 2)
        await advance_in_steps(server, graph, 2.0)
        cabin, *doors = elevator_state(server)
        assert 0.0 < cabin < 6.0
        assert doors == [0.0, 0.0, 0.0]
        await advance_in_steps(server, graph, 2.3)
        assert elevator_state(server) == (6.0, 0.0, 0.0, 1.0)
        assert recording.last.data == 2
        await advance_in_steps(server, graph, 2.0)
        assert elevator_state(server) == (6.0, 0.0, 0.0, 0.0)
        assert not log


async def test_door_of_current_floor_opens_at_once():
    async with running_server(elevator_model()) as (server, graph, _):
        await command_floors(server, graph, 0)
        await advance_in_steps(server, graph, 0.9)
        assert elevator_state(server) == (0.0, 1.0, 0.0, 0.0)


async def test_floor_on_the_way_is_visited_first():
    async with running_server(elevator_model()) as (server, graph, _):
        await command_floors(server, graph, 0)
        await advance_in_steps(server, graph, 0.3)
        await command_floors(server, graph, 2, 1)
        assert await visited_floors(server, graph, 12.0) == [0, 1, 2]


async def test_obstacle_keeps_door_open():
    async with running_server(elevator_model()) as (server, graph, _):
        await command_floors(server, graph, 0)
        scan_type = "sensor_msgs/msg/LaserScan"
        publisher = graph.create_node("lidar").create_publisher(scan_type, "/model/tower/door_0/lidar", 10)
        publisher.publish(get_message(scan_type)(ranges=[0.5], range_max=1.0))
        await graph.settle()
        await advance_in_steps(server, graph, 4.0)
        assert elevator_state(server)[1] == 1.0
        publisher.publish(get_message(scan_type)(ranges=[1.0], range_max=1.0))
        await graph.settle()
        await advance_in_steps(server, graph, 0.8)
        assert elevator_state(server)[1] == 1.0
        await advance_in_steps(server, graph, 2.0)
        assert elevator_state(server)[1] == 0.0


async def test_names_and_topics_are_parameters():
    text = elevator_model("<cmd_topic>/go</cmd_topic><state_topic>/at</state_topic><cabin_joint>car</cabin_joint>")
    text = text.replace('"lift"', '"car"').replace(">lift<", ">car<")
    async with running_server(text) as (server, graph, log):
        recording = Recording(graph, server.node, "/at")
        await command_floors(server, graph, 1, topic="/go")
        await advance_in_steps(server, graph, 3.0)
        assert server.simulation.joint_state("tower::car")[0] == pytest.approx(3.0, abs=0.1)
        assert recording.last.data == 1
        assert not log


async def test_missing_floors_and_unknown_floor_are_reported():
    async with running_server(elevator_model("<floor_link_prefix>level_</floor_link_prefix>")) as (_, __, log):
        assert any("there is no link 'level_0'" in record.text for record in log)
    async with running_server(elevator_model()) as (server, graph, log):
        await command_floors(server, graph, 3)
        server.advance(SECOND_NS // 10)
        assert [record.text for record in log] == ["the elevator 'tower' has no floor 3"]
