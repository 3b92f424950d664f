"""Effort: rings about the joints."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.viewer.contents import unpack_contents
from tests.viewer.scene import open_world

JointState = get_message("sensor_msgs/msg/JointState")

CRANE = """\
<robot name="crane">
  <link name="base"/><link name="arm"/><link name="hook"/><link name="sledge"/>
  <joint name="lift" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="1" effort="10" velocity="1"/></joint>
  <joint name="spin" type="continuous"><parent link="arm"/><child link="hook"/></joint>
  <joint name="slide" type="prismatic"><parent link="arm"/><child link="sledge"/>
    <limit lower="0" upper="1" effort="10" velocity="1"/></joint>
</robot>
"""


def make_config(extra: str = "") -> RvizConfig:
    return RvizConfig.parse(
        "Visualization Manager:\n  Global Options: {Fixed Frame: base}\n  Displays:\n"
        f"    - {{Class: rviz_default_plugins/Effort, Enabled: true, Topic: {{Value: /joint_states}}{extra}}}\n"
    )


def make_joint_state(**efforts: float):
    return JointState(name=list(efforts), position=[0.0] * len(efforts), effort=list(efforts.values()))


async def describe_crane(world):
    world.describe(CRANE)
    world.move({("base", "arm"): (0, 0, 1, 0, 0, 0, 1), ("arm", "hook"): (1, 0, 0, 0, 0, 0, 1)}, static=True)
    await world.settle()
    return world.graph.create_node("talker").create_publisher(JointState, "/joint_states", 10)


async def test_effort_properties_match_rviz():
    async with open_world(make_config()) as world:
        await describe_crane(world)
        rows = {row.name: row for row in world.display("Effort").row().properties}
        assert {name: row.value for name, row in rows.items()} == {
            "Topic": "/joint_states",
            "Alpha": 1.0,
            "Width": 0.02,
            "Scale": 1.0,
            "History Length": 1,
            "Robot Description": "/robot_description",
            "TF Prefix": "",
            "Joints": None,
        }
        (lift,) = rows["Joints"].children
        assert (lift.name, lift.value, lift.details) == ("lift", True, "effort")
        assert world.status("Effort")["URDF"] == ("ok", "Robot model parsed Ok")


async def test_effort_ring_is_perpendicular_to_joint_axis():
    async with open_world(make_config()) as world:
        out = await describe_crane(world)
        out.publish(make_joint_state(lift=-5.0, spin=1.0, slide=2.0))
        await world.settle()
        (content,) = unpack_contents(world.display("Effort"))
        assert (content.frame, content.pose) == ("", None)
        assert content.fields["joints"] == ["lift"]
        assert (content.fields["efforts"].tolist(), content.fields["limits"].tolist()) == ([-5], [10])
        x, y, z, *turn = content.fields["poses"]
        assert (x, y, z) == (0, 0, 1)
        half = math.sqrt(0.5)
        np.testing.assert_allclose(turn, [-half, 0, 0, half], atol=1e-6)
        assert world.status("Effort")["lift"] == ("ok", "OK")


@pytest.mark.parametrize(
    ("message", "row", "text"),
    [
        (JointState(name=["lift"]), "Message", "different joint names and efforts size"),
        (make_joint_state(lift=math.nan), "lift", "Invalid effort: nan"),
    ],
)
async def test_invalid_joint_states_are_reported(message, row, text):
    async with open_world(make_config()) as world:
        out = await describe_crane(world)
        out.publish(message)
        await world.settle()
        level, status = world.status("Effort")[row]
        assert (level, text in status) == ("error", True)


async def test_no_rings_without_robot_description():
    async with open_world(make_config()) as world:
        out = world.graph.create_node("talker").create_publisher(JointState, "/joint_states", 10)
        out.publish(make_joint_state(lift=1.0))
        await world.settle()
        assert world.status("Effort")["Message"] == ("error", "Robot model might not be loaded yet")
        world.describe("<robot name='broken'/>")
        await world.settle()
        assert world.status("Effort")["URDF"] == ("error", "Unable to parse robot model description!")


async def test_message_waits_for_transform_of_frame():
    async with open_world(make_config(", TF Prefix: one")) as world:
        out = await describe_crane(world)
        out.publish(make_joint_state(lift=1.0))
        await world.settle()
        assert unpack_contents(world.display("Effort")) == []
        level, text = world.status("Effort")["Transform"]
        assert (level, "[one/arm]" in text) == ("error", True)
        world.display("Effort").set_property(("TF Prefix",), "")
        out.publish(make_joint_state(lift=1.0))
        await world.settle()
        assert len(unpack_contents(world.display("Effort"))) == 1
