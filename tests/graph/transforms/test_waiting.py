"""Lookups that wait for a transform, listeners and broadcasters."""

from __future__ import annotations

import asyncio
import threading

import pytest

from linkwright.graph import ExtrapolationException, LookupException, TransformListener
from linkwright.graph.time.values import Duration, Time
from linkwright.graph.transforms.broadcaster import StaticTransformBroadcaster, TransformBroadcaster
from linkwright.graph.transforms.waiting import Buffer
from linkwright.messages import TFMessage, get_service
from tests.graph.transforms.test_core import make_transform
from tests.waiting import TIMEOUT_S

LATEST = Time()


def test_lookup_waits_for_transform_from_another_thread():
    buffer = Buffer()
    timer = threading.Timer(0.05, lambda: buffer.set_transform(make_transform("map", "base", 1, x=2.0), "me"))
    timer.start()
    transform = buffer.lookup_transform("map", "base", LATEST, timeout=Duration(seconds=TIMEOUT_S))
    assert transform.transform.translation.x == 2.0
    timer.join()


def test_wait_timeout_returns_reason():
    buffer = Buffer()
    assert buffer.can_transform("map", "base", LATEST, Duration(seconds=0.02)) is False
    possible, reason = buffer.can_transform("map", "base", LATEST, return_debug_tuple=True)
    assert (possible, reason) == (
        False,
        'Invalid frame ID "map" passed to canTransform argument target_frame - frame does not exist',
    )
    with pytest.raises(LookupException):
        buffer.lookup_transform("map", "base", LATEST)
    buffer.set_transform(make_transform("map", "base", 1), "me")
    with pytest.raises(ExtrapolationException):
        buffer.lookup_transform_full("map", Time(seconds=1), "base", Time(seconds=9), "map", Duration(seconds=0.01))
    question = ("base", Time(seconds=1), "base", Time(seconds=1), "map")
    assert buffer.can_transform_full(*question)
    assert buffer.can_transform_full(*question, return_debug_tuple=True) == (True, "")
    assert buffer.lookup_transform_full(*question).child_frame_id == "base"


async def test_async_wait_completes_when_transform_arrives():
    buffer = Buffer()
    future = buffer.wait_for_transform_async("map", "base", Time(seconds=2))
    buffer.set_transform(make_transform("map", "base", 1), "me")
    assert not future.done()
    buffer.set_transform(make_transform("map", "base", 3, x=4.0), "me")
    assert future.result().transform.translation.x == pytest.approx(2.0)
    assert buffer.wait_for_transform_async("map", "base", Time(seconds=2)).done()
    assert buffer._new_data_callbacks == []
    task = asyncio.ensure_future(buffer.lookup_transform_async("map", "arm", LATEST))
    full = asyncio.ensure_future(
        buffer.lookup_transform_full_async("map", Time(seconds=2), "arm", Time(seconds=2), "map")
    )
    await asyncio.sleep(0)
    assert not task.done()
    buffer.set_transform_static(make_transform("base", "arm", x=1.0), "me")
    assert (await asyncio.wait_for(task, 1)).transform.translation.x == pytest.approx(5.0)
    assert (await asyncio.wait_for(full, 1)).transform.translation.x == pytest.approx(3.0)
    buffer.wait_for_transform_async("map", "gone", LATEST).cancel()
    assert buffer._new_data_callbacks == []


async def test_buffer_offers_frame_graph_service_and_clears_on_time_jump_back(graph, clock, log):
    node = graph.create_node("node")
    buffer = Buffer(node=node)
    buffer.set_transform(make_transform("map", "base", 1), "me")
    client = graph.create_node("asking").create_client(get_service("tf2_msgs/srv/FrameGraph"), "/tf2_frames")
    response = client.call_async(client.srv_type.Request())
    await graph.settle()
    assert response.result().frame_yaml.startswith("base: \n  parent: 'map'\n")
    buffer.set_transform(make_transform("", "base", 1), "me")
    assert log[-1].node == "node.tf2"
    assert log[-1].text.startswith("TF_NO_FRAME_ID")


async def test_broadcasters_reach_transform_listener(graph, clock):
    node = graph.create_node("robot", namespace="/r")
    moving, static = TransformBroadcaster(node), StaticTransformBroadcaster(node)
    messages = []
    buffer = Buffer()
    listener = TransformListener(buffer, graph.create_node("listener"))
    static.sendTransform(make_transform("base", "camera", x=1.0))
    static.sendTransform([make_transform("base", "laser", x=2.0), make_transform("base", "camera", x=3.0)])
    moving.sendTransform(make_transform("map", "base", 5, x=10.0))
    moving.sendTransform((make_transform("map", "base", 6, x=11.0), make_transform("base", "arm", 6)))
    await graph.settle()
    assert buffer.lookup_transform("map", "camera", LATEST).transform.translation.x == 14.0
    assert buffer.lookup_transform("map", "laser", Time(seconds=5)).transform.translation.x == 12.0
    graph.create_node("late").create_subscription(TFMessage, "/tf_static", messages.append, static.pub_tf.qos_profile)
    await graph.settle()
    (message,) = messages
    assert [transform.child_frame_id for transform in message.transforms] == ["camera", "laser"]
    listener.unregister()
    moving.sendTransform(make_transform("map", "base", 7))
    await graph.settle()
    assert buffer.get_latest_common_time("map", "base") == Time(seconds=6)


async def test_transform_listener_topics_can_be_changed(graph):
    node = graph.create_node("node")
    buffer = Buffer()
    TransformListener(buffer, node, tf_topic="/moving", tf_static_topic="/fixed", static_only=True)
    assert [name for name in graph.topics() if name in ("/tf", "/tf_static", "/moving", "/fixed")] == ["/fixed"]
