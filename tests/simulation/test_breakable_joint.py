"""Joints that break when they carry more than a force."""

from __future__ import annotations

import pytest

from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import box

MASS, GRAVITY = 2.0, 9.81
WEIGHT = MASS * GRAVITY


def hung_box(kind: str, parameters: str, axis: str = "", name: str = "box", height: float = 2.0) -> str:
    """Return a box that hangs on a joint to the world, with the plugin."""
    plugin = f'<plugin name="breaker" filename="libBreakableJointPlugin.so">{parameters}</plugin>'
    joint = (
        f'<joint name="hook" type="{kind}"><parent>world</parent><child>link</child>{axis}'
        f'<sensor name="force" type="force_torque"><update_rate>1000</update_rate>{plugin}</sensor></joint>'
    )
    return box(name, f"0 0 {height} 0 0 0", "0.2 0.2 0.2", MASS).replace("</model>", f"{joint}</model>")


def breaking_force(newtons: float) -> str:
    """Return the parameter of the plugin."""
    return f"<breaking_force_N>{newtons}</breaking_force_N>"


AXIS = "<axis><xyz>0 0 1</xyz>{limit}</axis>"
NO_RANGE = AXIS.format(limit="<limit><lower>0</lower><upper>0</upper></limit>")
HINGE = "<axis><xyz>0 1 0</xyz></axis>"


@pytest.mark.parametrize(
    ("kind", "axis"),
    [("fixed", ""), ("revolute", NO_RANGE), ("prismatic", NO_RANGE), ("ball", ""), ("revolute", HINGE)],
)
async def test_joint_holds_the_weight_up_to_its_breaking_force(kind: str, axis: str):
    async with running_server(hung_box(kind, breaking_force(1.05 * WEIGHT), axis)) as (server, _, log):
        server.advance(SECOND_NS)
        assert server.simulation.link_pose("box::link")[2] == pytest.approx(2.0, abs=1e-3)
        assert not log


@pytest.mark.parametrize(("kind", "axis"), [("fixed", ""), ("revolute", NO_RANGE), ("ball", "")])
async def test_joint_breaks_under_a_greater_force_and_the_link_falls(kind: str, axis: str):
    async with running_server(hung_box(kind, breaking_force(0.95 * WEIGHT), axis)) as (server, _, log):
        server.advance(SECOND_NS // 2)
        fallen = 2.0 - server.simulation.link_pose("box::link")[2]
        assert fallen == pytest.approx(GRAVITY * 0.5**2 / 2, abs=0.05)
        assert [str(record) for record in log if "breaks under a force of" in str(record)]


async def test_default_breaking_force_is_one_newton():
    async with running_server(hung_box("fixed", "")) as (server, *_):
        server.advance(SECOND_NS // 2)
        assert server.simulation.link_pose("box::link")[2] < 1.0


async def test_push_breaks_the_joint_that_held_the_weight():
    async with running_server(hung_box("fixed", breaking_force(50.0))) as (server, *_):
        simulation = server.simulation
        server.advance(SECOND_NS)
        assert simulation.link_pose("box::link")[2] == pytest.approx(2.0, abs=1e-3)
        simulation.push("box::link", (0.0, 0.0, -40.0), by="hand")
        server.advance(SECOND_NS // 10)
        simulation.push("box::link", (0.0, 0.0, 0.0), by="hand")
        server.advance(SECOND_NS // 2)
        assert simulation.link_pose("box::link")[2] < 1.0


async def test_reset_connects_the_links_again():
    async with running_server(hung_box("fixed", breaking_force(50.0))) as (server, *_):
        simulation = server.simulation
        simulation.push("box::link", (0.0, 0.0, -40.0), by="hand")
        server.advance(SECOND_NS // 2)
        assert simulation.link_pose("box::link")[2] < 1.0
        simulation.push("box::link", (0.0, 0.0, 0.0), by="hand")
        server.reset()
        server.advance(SECOND_NS)
        assert simulation.link_pose("box::link")[2] == pytest.approx(2.0, abs=1e-3)


async def test_other_joints_of_a_model_stay_when_one_breaks():
    weak, strong = hung_box("fixed", breaking_force(10.0)), hung_box("fixed", breaking_force(30.0), name="strong")
    async with running_server(weak, strong) as (server, *_):
        server.advance(SECOND_NS // 2)
        assert server.simulation.link_pose("box::link")[2] < 1.5
        assert server.simulation.link_pose("strong::link")[2] == pytest.approx(2.0, abs=1e-3)


async def test_sliding_joint_cannot_break():
    async with running_server(hung_box("prismatic", "", AXIS.format(limit=""))) as (_, _, log):
        assert any("joint that can break" in str(record) for record in log)
