"""The Joints panel: its rows, and the positions that it publishes."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest

from linkwright.graph import Graph
from linkwright.nodes import NodeOptions
from linkwright.nodes.joint_state_publisher_gui import JointStatePublisherGui
from linkwright.page.protocol.robot import CenterJoints, JointPositions, Joints, RandomizeJoints, SetJoint, SetJoints
from linkwright.panels.joints import JointsFeature
from tests.waiting import eventually

PAGE = object()
"""The page that sends requests; the bridge informs all pages."""

GRIPPER = """\
<robot name="gripper">
  <link name="base"/><link name="arm"/><link name="left"/><link name="right"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/></joint>
  <joint name="open" type="prismatic">
    <parent link="arm"/><child link="left"/><limit lower="0.01" upper="0.05" effort="1" velocity="1"/>
  </joint>
  <joint name="follow" type="prismatic">
    <parent link="arm"/><child link="right"/><limit lower="-0.1" upper="0.1" effort="1" velocity="1"/>
    <mimic joint="open" multiplier="-1"/>
  </joint>
</robot>
"""


@pytest.fixture
async def graph():
    graph = Graph(on_log=lambda _: None)
    yield graph
    await graph.close()


@pytest.fixture
async def panel(graph):
    options = NodeOptions(parameters={"robot_description": GRIPPER}, arguments=[])
    running = JointStatePublisherGui(graph, options)
    return running.panel


@pytest.fixture
def published_messages():
    return []


@pytest.fixture
def bridge(published_messages):
    pages = SimpleNamespace(publish=published_messages.append)
    return JointsFeature(SimpleNamespace(context=SimpleNamespace(pages=pages), managers=None))


async def until_published(graph, bridge):
    """Wait until the bridge reports a change."""
    await graph.settle()
    await eventually(lambda: bridge._send_timer is None)


async def fill_panel(graph, panel):
    from linkwright.graph import DESCRIPTION_QOS
    from linkwright.messages import String

    graph.create_node("rsp").create_publisher(String, "robot_description", DESCRIPTION_QOS).publish(
        String(data=GRIPPER)
    )
    await graph.settle()
    assert panel.sliders()


def test_bridge_without_panel_has_no_joints(bridge):
    assert bridge.opening_messages() == [Joints(None)]
    bridge.receive(PAGE, RandomizeJoints())


async def test_attached_panel_publishes_controls_and_positions(graph, bridge, panel, published_messages):
    await fill_panel(graph, panel)
    bridge.attach(panel)
    controls, positions = published_messages
    by_name = {control.name: control for control in controls.controls}
    assert (by_name["turn"].kind, by_name["turn"].lower, by_name["turn"].upper) == ("continuous", -math.pi, math.pi)
    assert (by_name["open"].lower, by_name["open"].upper) == (0.01, 0.05)
    assert by_name["open"].zero == pytest.approx(0.03)
    follow = by_name["follow"]
    assert (follow.mimic, follow.multiplier, follow.offset) == ("open", -1.0, 0.0)
    assert positions.positions == pytest.approx({"turn": 0.0, "open": 0.03, "follow": -0.03})
    assert bridge.opening_messages() == published_messages


async def test_joint_rows_follow_description(graph, bridge, panel, published_messages):
    bridge.attach(panel)
    assert published_messages[0] == Joints([])
    await fill_panel(graph, panel)
    await until_published(graph, bridge)
    last = {type(message): message for message in published_messages}
    assert [control.name for control in last[Joints].controls] == ["turn", "open", "follow"]
    assert set(last[JointPositions].positions) == {"turn", "open", "follow"}


async def test_pages_move_free_joints(graph, bridge, panel, published_messages):
    await fill_panel(graph, panel)
    bridge.attach(panel)
    bridge.receive(PAGE, SetJoint("turn", 0.5))
    bridge.receive(PAGE, SetJoint("open", 7.0))
    bridge.receive(PAGE, SetJoint("follow", 0.0))
    bridge.receive(PAGE, SetJoint("nobody", 0.0))
    await until_published(graph, bridge)
    assert published_messages[-1].positions == pytest.approx({"turn": 0.5, "open": 0.05, "follow": -0.05})
    bridge.receive(PAGE, SetJoints({"turn": -0.25, "open": 0.02, "follow": 1.0, "nobody": 1.0}))
    await until_published(graph, bridge)
    assert published_messages[-1].positions == pytest.approx({"turn": -0.25, "open": 0.02, "follow": -0.02})
    bridge.receive(PAGE, CenterJoints())
    await until_published(graph, bridge)
    assert published_messages[-1].positions == pytest.approx({"turn": 0.0, "open": 0.03, "follow": -0.03})
    bridge.receive(PAGE, RandomizeJoints())
    await until_published(graph, bridge)
    assert published_messages[-1].positions["turn"] != 0.0


async def test_detached_panel_publishes_nothing(graph, bridge, panel, published_messages):
    await fill_panel(graph, panel)
    bridge.attach(panel)
    bridge.attach(None)
    assert published_messages[-1] == Joints(None)
    count = len(published_messages)
    panel.randomize()
    await until_published(graph, bridge)
    assert len(published_messages) == count
