"""Grippers that hold objects: the grasp fix, and the vacuum gripper."""

from __future__ import annotations

import pytest

from linkwright.messages import get_message, get_service
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND, box

# --- grasp fix --------------------------------------------------------------------------------------------------------


def _finger(name: str, y: float, axis: str) -> str:
    return (
        f'<link name="{name}"><pose>0 {y} 0 0 0 0</pose><inertial><mass>0.2</mass></inertial><collision name="pad">'
        "<geometry><box><size>0.04 0.01 0.04</size></box></geometry></collision></link>"
        f'<joint name="{name}_joint" type="prismatic"><parent>palm</parent><child>{name}</child><axis><xyz>{axis}</xyz>'
        "<limit><lower>-0.03</lower><upper>0.02</upper></limit></axis></joint>"
        f'<plugin name="{name}" filename="gz-sim-apply-joint-force-system"><joint_name>{name}_joint</joint_name>'
        "</plugin>"
    )


def hand_model(extra: str = "", arm: str = "<palm_link>palm</palm_link>") -> str:
    """Return a hand that is fixed to the world and that two forces close."""
    plugin = (
        f'<plugin name="fix" filename="libgazebo_grasp_fix.so"><arm><arm_name>arm</arm_name>{arm}'
        "<gripper_link>left</gripper_link><gripper_link>right</gripper_link></arm><update_rate>20</update_rate>"
        f"<grip_count_threshold>2</grip_count_threshold><max_grip_count>4</max_grip_count>{extra}</plugin>"
    )
    return (
        '<model name="hand"><pose>0 0 1 0 0 0</pose><link name="palm"><inertial><mass>1</mass></inertial></link>'
        '<joint name="mount" type="fixed"><parent>world</parent><child>palm</child></joint>'
        f"{_finger('left', 0.04, '0 -1 0')}{_finger('right', -0.04, '0 1 0')}{plugin}</model>"
    )


SLIPPERY = "<surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction></surface>"
EGG = box("egg", "0 0 1 0 0 0", "0.04 0.06 0.04", 0.1, SLIPPERY)


async def squeeze(graph, force: float) -> None:
    """Push both fingers inward with a force in N."""
    node = graph.create_node(f"operator_{'close' if force > 0.0 else 'open'}")
    for finger in ("left", "right"):
        topic = f"/model/hand/joint/{finger}_joint/cmd_force"
        publisher = node.create_publisher("std_msgs/msg/Float64", topic, 10)
        publisher.publish(get_message("std_msgs/msg/Float64")(data=force))
    await graph.settle()


def link_height(server, name: str = "egg") -> float:
    return server.simulation.model_pose(name)[2]


async def test_gripped_object_stays_until_fingers_open():
    for extra in ("", "<disable_collisions_on_attach>true</disable_collisions_on_attach>"):
        async with running_server(hand_model(extra), EGG, gravity="0 0 -0.02") as (server, graph, log):
            await squeeze(graph, 5.0)
            server.advance(SECOND_NS)
            held_height = link_height(server)
            server.simulation.set_gravity((0.0, 0.0, -9.81))
            server.advance(SECOND_NS)
            assert link_height(server) == pytest.approx(held_height, abs=0.002)
            assert not log
            await squeeze(graph, -1.0)
            server.advance(SECOND_NS)
            assert link_height(server) < 0.5


async def test_object_slips_without_plugin_or_with_force_from_one_side():
    hand_without_plugin = hand_model().replace('filename="libgazebo_grasp_fix.so"', 'filename="gz-sim-label-system"')
    one_sided = hand_model().replace("<gripper_link>right</gripper_link>", "")
    for text in (hand_without_plugin, one_sided):
        async with running_server(text, EGG, gravity="0 0 -0.02") as (server, graph, _):
            await squeeze(graph, 5.0)
            server.advance(SECOND_NS)
            server.simulation.set_gravity((0.0, 0.0, -9.81))
            server.advance(SECOND_NS)
            assert link_height(server) < 0.5


async def test_reset_releases_object():
    async with running_server(hand_model(), EGG, gravity="0 0 -0.02") as (server, graph, _):
        await squeeze(graph, 5.0)
        server.advance(SECOND_NS)
        assert server.simulation.scene.is_welded("hand::palm", "egg::link")
        server.reset()
        assert not server.simulation.scene.is_welded("hand::palm", "egg::link")


async def test_object_that_is_deleted_in_gripper_is_forgotten():
    async with running_server(hand_model(), EGG, gravity="0 0 -0.02") as (server, graph, log):
        await squeeze(graph, 5.0)
        server.advance(SECOND_NS)
        server.delete("egg")
        server.advance(SECOND_NS // 2)
        assert not log


async def test_arm_without_palm_is_reported():
    async with running_server(hand_model(arm="")) as (_, __, log):
        assert any("needs an <arm> with a <palm_link>" in record.text for record in log)


# --- vacuum gripper ---------------------------------------------------------------------------------------------------


def vacuum_cup(parameters: str = "<link_name>cup</link_name>") -> str:
    return (
        '<model name="robot"><pose>0 0 1 0 0 0</pose><link name="cup"><inertial><mass>1</mass></inertial></link>'
        '<joint name="mount" type="fixed"><parent>world</parent><child>cup</child></joint>'
        f'<plugin name="gripper" filename="libgazebo_ros_vacuum_gripper.so">{parameters}</plugin></model>'
    )


async def call_between_steps(server, graph, type_name: str, service: str, **values):
    """Call a service between two steps, and return the response."""
    future = (
        graph.create_node(f"operator_{server.simulation.time}")
        .create_client(type_name, service)
        .call_async(get_service(type_name).Request(**values))
    )
    await graph.settle()
    server.advance(SECOND_NS // 1000)
    await graph.settle()
    return future.result()


LEAF = box("leaf", "0 0 0.97 0 0 0", "0.02 0.02 0.02", 0.01)


async def test_switched_on_gripper_attracts_close_links():
    far_box = box("far", "0 0.5 1 0 0 0", "0.02 0.02 0.02", 0.01)
    async with running_server(vacuum_cup(), LEAF, far_box, gravity="0 0 0") as (server, graph, log):
        recording = Recording(graph, server.node, "/grasping")
        server.advance(SECOND_NS // 1000)
        await graph.settle()
        assert not recording.last.data
        assert (await call_between_steps(server, graph, "std_srvs/srv/SetBool", "/switch", data=True)).success
        server.advance(SECOND_NS // 1000)
        forces = [server.simulation.data.body(f"{name}::link").xfrc_applied[2] for name in ("leaf", "far")]
        await graph.settle()
        assert forces == pytest.approx([1.0, 0.0])
        assert recording.last.data
        assert not log
        assert not (await call_between_steps(server, graph, "std_srvs/srv/SetBool", "/switch", data=True)).success
        assert [record.text for record in log] == ["the gripper is already on"]
        assert (await call_between_steps(server, graph, "std_srvs/srv/SetBool", "/switch", data=False)).success
        server.advance(SECOND_NS // 1000)
        assert server.simulation.data.body("leaf::link").xfrc_applied[2] == 0.0


async def test_exempted_model_and_greater_distance_are_not_attracted():
    parameters = "<link_name>cup</link_name><max_distance>{}</max_distance><fixed>{}</fixed>"
    for distance, exempted, force in ((0.05, "leaf", 0.0), (0.01, "wall", 0.0), (0.05, "wall", 1.0)):
        async with running_server(vacuum_cup(parameters.format(distance, exempted)), LEAF, gravity="0 0 0") as (
            server,
            graph,
            _,
        ):
            await call_between_steps(server, graph, "std_srvs/srv/SetBool", "/switch", data=True)
            server.advance(SECOND_NS // 1000)
            assert server.simulation.data.body("leaf::link").xfrc_applied[2] == pytest.approx(force)


async def test_gripper_of_ros_1_holds_object_against_gravity():
    parameters = "<bodyName>cup</bodyName><topicName>holding</topicName><robotNamespace>arm</robotNamespace>"
    async with running_server(
        GROUND, vacuum_cup(parameters), box("egg", "0 0 0.97 0 0 0", "0.02 0.02 0.02", 0.1)
    ) as running:
        server, graph, _ = running
        recording = Recording(graph, server.node, "/arm/holding")
        await call_between_steps(server, graph, "std_srvs/srv/Empty", "/arm/on")
        server.advance(SECOND_NS)
        await graph.settle()
        assert recording.last.data
        assert link_height(server) == pytest.approx(1.0, abs=0.05)
        await call_between_steps(server, graph, "std_srvs/srv/Empty", "/arm/off")
        server.advance(SECOND_NS)
        assert link_height(server) < 0.1
