"""gz's scene broadcaster, which publishes the poses of a world."""

from __future__ import annotations

import pytest

from linkwright.graph import Graph
from linkwright.nodes import NodeOptions
from linkwright.simulation.nodes.bridge import ParameterBridge
from linkwright.simulation.nodes.simulator import GzServer, Simulator
from linkwright.simulation.plugins.registry import DEFAULT_GZ_SYSTEMS
from linkwright.simulation.server.server import ServerOptions
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, robot, running_server
from tests.simulation.worlds import GROUND, box, model

BROADCASTER = '<plugin name="gz::sim::systems::SceneBroadcaster" filename="gz-sim-scene-broadcaster-system"/>'
ALL, DYNAMIC = "/world/test/pose/info", "/world/test/dynamic_pose/info"
LINKS = ["base_link", "left_wheel", "right_wheel", "front_caster", "back_caster"]


def frame_names(message):
    return [transform.child_frame_id for transform in message.transforms]


def translation_of(message, name):
    position = next(
        transform for transform in message.transforms if transform.child_frame_id == name
    ).transform.translation
    return position.x, position.y, position.z


async def test_dynamic_poses_list_models_before_links():
    async with running_server(GROUND, robot(), BROADCASTER) as (server, graph, log):
        recording = Recording(graph, server.node, DYNAMIC)
        server.advance(SECOND_NS)
        await graph.settle()
        assert 59 <= len(recording) <= 61
        assert frame_names(recording.last) == ["mbot", *LINKS]
        assert translation_of(recording.last, "mbot") == pytest.approx((0.0, 0.0, 0.11), abs=2e-3)
        assert translation_of(recording.last, "left_wheel") == pytest.approx((0.0, 0.19, -0.05), abs=1e-3)
        assert {transform.header.frame_id for transform in recording.last.transforms} == {""}
        assert recording.last.transforms[0].header.stamp.nanosec > 0.9 * SECOND_NS
        assert not log


async def test_all_poses_include_visuals_and_lights():
    light = '<light name="sun" type="directional"><pose>0 0 10 0 0 0</pose></light>'
    crate = box("crate", "3 0 0.5 0 0 0", "1 1 1")
    visual = (
        '<visual name="lid"><pose>0 0 0.5 0 0 0</pose><geometry><box><size>1 1 0.1</size></box></geometry></visual>'
    )
    async with running_server(GROUND, crate.replace("</link>", f"{visual}</link>"), light, BROADCASTER) as (
        server,
        graph,
        log,
    ):
        recording = Recording(graph, server.node, ALL)
        server.advance(SECOND_NS // 10)
        await graph.settle()
        assert frame_names(recording.last) == ["ground", "crate", "link", "link", "lid", "sun"]
        assert translation_of(recording.last, "lid") == (0.0, 0.0, 0.5)
        assert translation_of(recording.last, "sun") == (0.0, 0.0, 10.0)
        assert not log


async def test_spawned_models_are_included_and_deleted_ones_removed():
    async with running_server(GROUND, BROADCASTER) as (server, graph, _):
        recording = Recording(graph, server.node, DYNAMIC)
        server.spawn(model(box("box", "0 0 0.5 0 0 0", "1 1 1")), "crate")
        server.advance(SECOND_NS // 10)
        await graph.settle()
        assert frame_names(recording.last) == ["crate", "link"]
        server.delete("crate")
        server.advance(SECOND_NS // 10)
        await graph.settle()
        assert frame_names(recording.last) == []


async def test_model_without_links_is_included():
    empty_model = '<model name="mark"><static>true</static><pose>1 2 3 0 0 0</pose></model>'
    async with running_server(GROUND, empty_model, BROADCASTER) as (server, graph, log):
        recording = Recording(graph, server.node, ALL)
        server.advance(SECOND_NS // 10)
        await graph.settle()
        assert translation_of(recording.last, "mark") == (1.0, 2.0, 3.0)
        assert not log


async def test_dynamic_pose_rate_is_configurable():
    slow = BROADCASTER.replace("/>", "><dynamic_pose_hertz>10</dynamic_pose_hertz></plugin>")
    async with running_server(GROUND, robot(), slow) as (server, graph, log):
        recording = Recording(graph, server.node, DYNAMIC)
        server.advance(SECOND_NS)
        await graph.settle()
        assert len(recording) == 10
        assert not log


async def test_default_gz_systems_apply_only_to_world_without_plugins():
    physics = '<plugin name="p" filename="gz-sim-physics-system"/>'
    for parts, publishes_poses in (((), True), ((physics,), False), ((physics, BROADCASTER), True)):
        async with running_server(GROUND, *parts, options=ServerOptions(systems=DEFAULT_GZ_SYSTEMS)) as (_, graph, log):
            assert (DYNAMIC in graph.topics()) == publishes_poses
            assert not log


@pytest.mark.parametrize(("node_type", "publishes_poses"), [(GzServer, True), (Simulator, False)])
async def test_only_gz_server_adds_default_gz_systems(node_type, publishes_poses):
    graph = Graph()
    simulator = node_type(graph, NodeOptions(parameters={"pause": True}))
    assert any(topic.endswith("/dynamic_pose/info") for topic in graph.topics()) == publishes_poses
    simulator.close()
    await graph.close()


@pytest.mark.parametrize("message_type", ["tf2_msgs/msg/TFMessage", "geometry_msgs/msg/PoseArray"])
async def test_bridge_forwards_poses(message_type):
    async with running_server(GROUND, robot(), BROADCASTER) as (server, graph, _):
        argument = f"{DYNAMIC}@{message_type}[gz.msgs.Pose_V"
        bridge = ParameterBridge(graph, NodeOptions(arguments=[argument], remappings=[(DYNAMIC, "/truth")]))
        recording = Recording(graph, server.node, "/truth")
        for _ in range(10):
            server.advance(SECOND_NS // 20)
            await graph.settle()
        last = recording.last
        assert len(last.transforms if message_type.startswith("tf2") else last.poses) == 1 + len(LINKS)
        bridge.close()
