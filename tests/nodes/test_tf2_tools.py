"""`tf2_echo`, `tf2_monitor` and `view_frames`."""

from __future__ import annotations

import asyncio
from math import pi

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.arrays import quaternion_from_rpy
from linkwright.graph import STATIC_TF_PUBLISHER_QOS, TF_QOS, ActionClient, Duration
from linkwright.graph.actions.goal import GoalStatus
from linkwright.messages import TFMessage, TransformBatch, get_action
from linkwright.nodes import NodeOptions
from linkwright.nodes.tf2_buffer_server import Tf2BufferServer
from linkwright.nodes.tf2_echo import Tf2Echo, format_transform
from linkwright.nodes.tf2_monitor import Tf2Monitor
from linkwright.nodes.view_frames import ViewFrames


@pytest.fixture
def send(harness):
    moving = harness.node.create_publisher(TFMessage, "/tf", TF_QOS)
    static = harness.node.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS)

    async def publish(parent, child, *, rpy=(0.0, 0.0, 0.0), xyz=(0.0, 0.0, 0.0), fixed=False):
        pose = np.array([[*xyz, *quaternion_from_rpy(rpy)]])
        batch = TransformBatch((parent,), (child,), harness.clock.now_ns(), pose)
        (static if fixed else moving).publish(TFMessage(batch=batch))
        await harness.graph.settle()

    return publish


def start_tool(harness, kind, *arguments):
    printed = []
    running = kind(harness.graph, NodeOptions(arguments=list(arguments), output=printed.append))
    return running, printed


async def test_tf2_echo_waits_and_prints_transform(harness, send, logged):
    _, printed = start_tool(harness, Tf2Echo, "map", "base", "2")
    await harness.clock.advance(1.2)
    waiting = 'Waiting for transform map ->  base: Invalid frame ID "map" passed to canTransform argument target_frame'
    assert logged("INFO")[0] == f"{waiting} - frame does not exist"
    assert printed == []
    await send("map", "base", xyz=(1.0, 0.5, 0.0), rpy=(0.0, 0.0, pi / 2))
    await harness.clock.advance(0.5)
    assert printed == [
        (
            "At time 1700000001.200000000\n"
            "- Translation: [1.000, 0.500, 0.000]\n"
            "- Rotation: in Quaternion (xyzw) [0.000, 0.000, 0.707, 0.707]\n"
            "- Rotation: in RPY (radian) [0.000, -0.000, 1.571]\n"
            "- Rotation: in RPY (degree) [0.000, -0.000, 90.000]\n"
            "- Matrix:\n"
            "  0.000 -1.000  0.000  1.000\n"
            "  1.000  0.000  0.000  0.500\n"
            "  0.000  0.000  1.000  0.000\n"
            "  0.000  0.000  0.000  1.000"
        )
    ]
    await harness.clock.advance(1.0)
    assert len(printed) == 3


async def test_tf2_echo_reports_lookup_failure(harness, send):
    running, printed = start_tool(harness, Tf2Echo, "map", "base")
    await send("map", "base")
    await harness.clock.advance(1.0)
    running._buffer.clear()
    await harness.clock.advance(1.0)
    assert printed[1].startswith("Failure at 1700000002.000\nException thrown:Could not find a connection")
    assert printed[1].endswith("The current list of frames is:\nFrame base exists with parent NO_PARENT.\n")


@pytest.mark.parametrize("pitch", [pi / 2, -pi / 2])
async def test_tf2_echo_handles_gimbal_lock(harness, send, pitch):
    _, printed = start_tool(harness, Tf2Echo, "map", "base")
    await send("map", "base", rpy=(0.0, pitch, 0.0))
    await harness.clock.advance(1.0)
    angle = "1.571" if pitch > 0 else "-1.571"
    assert f"- Rotation: in RPY (radian) [0.000, {angle}, " in printed[0].replace("[-0.000", "[0.000")


async def test_tf2_echo_rejects_invalid_arguments(harness):
    running, printed = start_tool(harness, Tf2Echo, "map")
    assert running.finished.result() == 1
    assert printed[0].startswith("Usage: tf2_echo source_frame target_frame [echo_rate]")
    with pytest.raises(LinkwrightError, match="Failed to convert rate argument 'fast' to a floating-point number"):
        start_tool(harness, Tf2Echo, "a", "b", "fast")


async def test_tf2_monitor_reports_all_frames(harness, send):
    _, printed = start_tool(harness, Tf2Monitor)
    for _ in range(4):
        await send("map", "base")
        await harness.clock.advance(0.25)
    await send("base", "arm", fixed=True)
    await harness.clock.advance(10.0)
    assert printed == [
        "Gathering data on all frames for 10 seconds...",
        (
            "\n\n\nRESULTS: for all Frames\n\nFrames:\n"
            "Frame: arm, published by <no authority available>, Average Delay: 0, Max Delay: 0\n"
            "Frame: base, published by <no authority available>, Average Delay: 0, Max Delay: 0\n\n"
            "All Broadcasters:\nNode: <no authority available> 5 Hz, Average Delay: 0 Max Delay: 0"
        ),
    ]


async def test_tf2_monitor_reports_chain_between_two_frames(harness, send):
    _, printed = start_tool(harness, Tf2Monitor, "map", "arm")
    await harness.clock.advance(1.0)
    assert printed == ["Waiting for transform chain to become available between map and arm "]
    await send("map", "base")
    await send("base", "arm")
    await send("base", "leg")
    await harness.clock.advance(0.5)
    assert printed[1] == "Gathering data on map -> arm for 10 seconds..."
    await harness.clock.advance(10.0)
    lines = printed[2].splitlines()
    assert lines[3:5] == ["RESULTS: for map to arm", "Chain is: map -> base -> arm"]
    assert lines[5].startswith("Net delay     avg = ")
    assert [line.split(",")[0] for line in lines[8:10]] == ["Frame: arm", "Frame: base"]
    assert start_tool(harness, Tf2Monitor, "one")[0].finished.result() == 255


async def test_view_frames_draws_tree(harness, send, logged, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    running, _ = start_tool(harness, ViewFrames, "-t", "2", "-o", "tree")
    await send("map", "base")
    await send("base", "camera", fixed=True)
    await harness.clock.advance(1.9)
    assert not running.finished.done()
    await harness.clock.advance(0.2)
    assert await asyncio.wait_for(running.finished, 1) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["tree.gv", "tree.pdf"]
    drawing = (tmp_path / "tree.gv").read_text()
    assert '"map" -> "base"[label=" Broadcaster: default_authority\\nAverage rate: 10000.0\\n' in drawing
    assert drawing.endswith('"Recorded at time: 1700000002.0"->"map";\n}')
    assert (tmp_path / "tree.pdf").read_bytes().startswith(b"%PDF")
    texts = logged("INFO")
    assert texts[0] == "Listening to tf data for 2.0 seconds..."
    assert texts[2].startswith("Result:tf2_msgs.srv.FrameGraph_Response(frame_yaml=\"base: \\n  parent: 'map'")
    assert texts[3] == "Exporting graph in tree.pdf file..."


async def test_view_frames_without_transforms_writes_placeholder(harness, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    running, _ = start_tool(harness, ViewFrames)
    await harness.clock.advance(5.0)
    assert running.finished.result() == 0
    (drawing,) = tmp_path.glob("frames_????-??-??_??.??.??.gv")
    assert drawing.read_text() == 'digraph G { "No tf data received" }'


async def test_view_frames_rejects_invalid_arguments(harness, logged, tmp_path):
    with pytest.raises(LinkwrightError, match="does not accept the arguments --wat"):
        start_tool(harness, ViewFrames, "--wat")
    with pytest.raises(LinkwrightError, match="-t: invalid float value: 'long'"):
        start_tool(harness, ViewFrames, "-t", "long")
    running, _ = start_tool(harness, ViewFrames, "-t", "0", "-o", str(tmp_path / "no" / "folder"))
    await harness.clock.advance(0.01)
    assert running.finished.result() == 1
    assert "cannot write" in logged("ERROR")[0]


async def test_describe_keeps_negative_zeros_like_tf2(harness, send):
    await send("a", "b")
    await harness.graph.settle()
    assert "[0.000, -0.000, 0.000]" in format_transform(harness.tf[0].transforms[0])


@pytest.fixture
def send_lookup_goal(harness):
    """Send a goal to a buffer server, and return the result."""
    Tf2BufferServer(harness.graph, NodeOptions())
    client = ActionClient(harness.node, "tf2_msgs/action/LookupTransform", "tf2_buffer_server")
    goal_class = get_action("tf2_msgs/action/LookupTransform").Goal

    def ask(timeout=0.0, **goal):
        return client.send_goal_async(goal_class(timeout=Duration(seconds=timeout).to_msg(), **goal))

    return ask


async def lookup_result(sent):
    return (await (await sent).get_result_async()).result


async def test_buffer_server_returns_transform(send_lookup_goal, send):
    await send("map", "base", xyz=(1.0, 2.0, 3.0))
    result = await lookup_result(send_lookup_goal(target_frame="map", source_frame="base"))
    assert (result.error.error, result.transform.transform.translation.y) == (0, 2.0)
    result = await lookup_result(
        send_lookup_goal(target_frame="map", source_frame="base", fixed_frame="map", advanced=True)
    )
    assert result.transform.child_frame_id == "base"


async def test_buffer_server_reports_lookup_error(send_lookup_goal, send):
    await send("map", "base")
    result = await lookup_result(send_lookup_goal(target_frame="map", source_frame="nowhere"))
    assert (result.error.error, "nowhere" in result.error.error_string) == (1, True)


async def test_buffer_server_waits_until_goal_timeout(harness, send_lookup_goal, send):
    early_goal, late_goal = (
        send_lookup_goal(timeout, target_frame="map", source_frame="base") for timeout in (0.5, 5.0)
    )
    await harness.clock.advance(1.0)
    await send("map", "base", xyz=(1.0, 0.0, 0.0))
    await harness.clock.advance(0.1)
    assert (await lookup_result(early_goal)).error.error == 1
    assert (await lookup_result(late_goal)).transform.transform.translation.x == 1.0


async def test_buffer_server_goal_can_be_canceled(harness, send_lookup_goal):
    handle = await send_lookup_goal(60.0, target_frame="map", source_frame="base")
    future = handle.get_result_async()
    handle.cancel_goal_async()
    await harness.clock.advance(0.1)
    assert (await future).status == GoalStatus.CANCELED
