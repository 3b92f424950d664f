"""gz's pose publisher."""

from __future__ import annotations

import pytest

from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, robot, running_server
from tests.simulation.worlds import GROUND, box


def pose_plugin(extra: str = "") -> str:
    """Return the plugin."""
    name = "gz::sim::systems::PosePublisher"
    return f'<plugin name="{name}" filename="gz-sim-pose-publisher-system">{extra}</plugin>'


def _translation(transform):
    translation = transform.transform.translation
    return translation.x, translation.y, translation.z


async def test_link_poses_are_published_as_separate_messages():
    async with running_server(GROUND, robot(pose_plugin("<update_frequency>10</update_frequency>"))) as (
        server,
        graph,
        log,
    ):
        recording = Recording(graph, server.node, "/model/mbot/pose")
        server.advance(SECOND_NS)
        await graph.settle()
        assert len(recording) == 5 * 10
        assert [transform.child_frame_id for transform in recording][-5:] == [
            "mbot/base_link",
            "mbot/left_wheel",
            "mbot/right_wheel",
            "mbot/front_caster",
            "mbot/back_caster",
        ]
        assert {transform.header.frame_id for transform in recording} == {"mbot"}
        assert [_translation(transform) for transform in recording][-4] == pytest.approx((0.0, 0.19, -0.05), abs=1e-3)
        assert recording.last.header.stamp.sec == 1
        assert not log


async def test_static_poses_have_separate_topic():
    settings = (
        "<use_pose_vector_msg>true</use_pose_vector_msg><static_publisher>1</static_publisher>"
        "<publish_model_pose>true</publish_model_pose><publish_collision_pose>true</publish_collision_pose>"
        "<publish_link_pose>true</publish_link_pose><update_frequency>50</update_frequency>"
        "<static_update_frequency>1</static_update_frequency>"
    )
    async with running_server(GROUND, robot(pose_plugin(settings))) as (server, graph, log):
        moving, resting = (Recording(graph, server.node, f"/model/mbot/{topic}") for topic in ("pose", "pose_static"))
        server.advance(SECOND_NS)
        await graph.settle()
        assert (len(moving), len(resting)) == (50, 1)
        assert [transform.child_frame_id for transform in moving.last.transforms] == [
            f"mbot/{side}" for side in ("left_wheel", "right_wheel", "front_caster", "back_caster")
        ]
        static_transforms = {transform.child_frame_id: transform for transform in resting.last.transforms}
        assert set(static_transforms) == {"mbot", "mbot/base_link"} | {
            f"mbot/{link}/collision"
            for link in ("base_link", "left_wheel", "right_wheel", "front_caster", "back_caster")
        }
        assert static_transforms["mbot"].header.frame_id == "test"
        assert static_transforms["mbot/left_wheel/collision"].header.frame_id == "mbot/left_wheel"
        assert _translation(static_transforms["mbot"]) == pytest.approx((0.0, 0.0, 0.11), abs=2e-3)
        assert not log


async def test_nested_model_poses_are_published():
    inner_model = box("inner", "0 0 0.5 0 0 0", "0.2 0.2 0.2")
    joint = '<joint name="j" type="fixed"><parent>link</parent><child>inner::link</child></joint>'
    settings = (
        "<publish_nested_model_pose>true</publish_nested_model_pose><publish_model_pose>false</publish_model_pose>"
        "<use_pose_vector_msg>true</use_pose_vector_msg>"
    )
    outer_model = box("outer", "1 0 3 0 0 0", "0.2 0.2 0.2").replace(
        "</model>", f"{inner_model}{joint}{pose_plugin(settings)}</model>"
    )
    async with running_server(outer_model) as (server, graph, log):
        recording = Recording(graph, server.node, "/model/outer/pose")
        server.advance(SECOND_NS // 100)
        await graph.settle()
        assert len(recording) == 10
        poses_by_frame = {
            transform.child_frame_id: (transform.header.frame_id, _translation(transform))
            for transform in recording.last.transforms
        }
        assert poses_by_frame == {
            "outer/link": ("outer", pytest.approx((0.0, 0.0, 0.0), abs=1e-9)),
            "outer/inner": ("outer", pytest.approx((0.0, 0.0, 0.5), abs=1e-9)),
            "outer/inner/link": ("outer/inner", pytest.approx((0.0, 0.0, 0.0), abs=1e-9)),
        }
        assert not log


async def test_static_model_publishes_poses():
    fixed_model = box("one", "0 0 1 0 0 0").replace("<link", "<static>true</static><link", 1)
    text = fixed_model.replace("</model>", pose_plugin("<publish_model_pose>1</publish_model_pose>") + "</model>")
    async with running_server(text) as (server, graph, log):
        recording = Recording(graph, server.node, "/model/one/pose")
        server.advance(SECOND_NS // 1000)
        await graph.settle()
        assert [(transform.child_frame_id, _translation(transform)) for transform in recording] == [
            ("one", pytest.approx((0.0, 0.0, 1.0))),
            ("one/link", pytest.approx((0.0, 0.0, 0.0))),
        ]
        assert not log
