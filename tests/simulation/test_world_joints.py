"""Joints of worlds, between links of their models."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from linkwright.simulation.server.unsimulated import find_unsimulated_elements
from tests.simulation.test_loading import load_world, step_simulation
from tests.simulation.test_server import simulator
from tests.simulation.worlds import box, make_simulation

BAR = """<model name="{name}"><pose>{pose}</pose><link name="link"><inertial><mass>1</mass><inertia>
<ixx>1e-9</ixx><iyy>1e-9</iyy><izz>1e-9</izz></inertia></inertial></link></model>"""
HINGE = '<axis><xyz>0 1 0</xyz></axis><pose relative_to="{at}"/>'


def joint(kind: str, parent: str, child: str, extra: str = "", name: str = "held") -> str:
    """Return a joint of a world."""
    return f'<joint name="{name}" type="{kind}"><parent>{parent}</parent><child>{child}</child>{extra}</joint>'


@pytest.mark.parametrize("parent", ["base", "base::link"])
def test_pendulum_of_two_models_has_textbook_period(parent):
    bob, base = BAR.format(name="bob", pose="0.05 0 1.001249 0 0 0"), box("base", "0 0 2 0 0 0")
    swing = joint("revolute", parent, "bob::link", HINGE.format(at="base"), name="swing")
    simulation = make_simulation(bob, base, joint("fixed", "world", "base", name="anchor"), swing)
    crossings = []
    for _ in range(4500):
        x_before = simulation.model_pose("bob")[0]
        simulation.advance(1_000_000)
        x_after = simulation.model_pose("bob")[0]
        if x_before * x_after < 0:
            crossings.append(simulation.seconds)
    assert len(crossings) == 4
    length = sqrt(0.05**2 + 0.998751**2)
    assert (crossings[2] - crossings[0]) == pytest.approx(2 * pi * sqrt(length / 9.81), rel=2e-3)
    assert simulation.model_pose("base")[:3] == (0, 0, 2)
    assert list(simulation.scene.models) == ["base", "bob"], "children are listed last"


def test_models_fixed_to_each_other_move_as_one():
    first, second = box("one", "0 0 9 0 0 0"), box("two", "1.5 0 9 0 0 0")
    simulation = make_simulation(second, first, joint("fixed", "one", "two"), gravity="0 0 0")
    simulation.set_model_velocity("one", (0.0, 0.0, 0.0), (0.0, 0.0, pi / 2))
    simulation.advance(1_000_000_000)
    first, second = (np.array(simulation.model_pose(name)) for name in ("one", "two"))
    assert np.linalg.norm(second[:3] - first[:3]) == pytest.approx(1.5, abs=1e-9)
    assert second[3:] == pytest.approx(first[3:], abs=1e-9)
    assert abs(first[5]) > 0.5, "both models rotate"


def test_prismatic_world_joint_stops_at_limits_for_either_child():
    post = box("post", "0 0 1 0 0 0").replace("<link", "<static>true</static><link", 1)
    rail = "<axis><xyz>0 0 1</xyz><limit><lower>-0.3</lower><upper>0.3</upper></limit></axis>"
    for parent, child, end in (("post", "slider", -0.3), ("slider", "post", 0.3)):
        simulation = make_simulation(
            post, box("slider", "0 0 1 0 0 0"), joint("prismatic", parent, child, rail, "rail")
        )
        simulation.advance(2_000_000_000)
        assert simulation.joint_state("rail")[0] == pytest.approx(end, abs=1e-3)
        assert simulation.model_pose("slider")[:3] == pytest.approx((0, 0, 0.7), abs=1e-3)


def test_ball_and_universal_joints_keep_distance():
    parts = [BAR.format(name=name, pose=f"{x} 0 3 0 0 0") for name, x in (("a", 0), ("b", 1), ("c", 2))]
    axes = "<axis><xyz>0 1 0</xyz></axis><axis2><xyz>0 0 1</xyz></axis2>"
    joints = (
        joint("fixed", "world", "a", name="anchor"),
        joint("universal", "a", "b", axes + '<pose relative_to="a"/>', "cross"),
        joint("ball", "b", "c", '<pose relative_to="b"/>', "socket"),
    )
    simulation = make_simulation(*parts, *joints)
    simulation.advance(700_000_000)
    a, b, c = (np.array(simulation.model_pose(name)[:3]) for name in "abc")
    assert np.linalg.norm(b - a) == pytest.approx(1, abs=1e-9)
    assert np.linalg.norm(c - b) == pytest.approx(1, abs=1e-9)
    assert c[2] < b[2] < 2.9


def test_loop_joint_is_closed_or_reported():
    ends = [box(name, f"{x} 0 3 0 0 0") for name, x in (("a", 0), ("b", 2))]
    bridge = box("bridge", "1 0 3 0 0 0")
    anchors = [joint("fixed", "world", name, name=f"hold_{name}") for name in "ab"]
    loop = [joint("fixed", name, "bridge", name=f"on_{name}") for name in "ab"]
    simulation = make_simulation(*ends, bridge, *anchors, *loop)
    simulation.advance(500_000_000)
    assert simulation.model_pose("bridge")[:3] == pytest.approx((1, 0, 3), abs=1e-3)
    simulation = make_simulation(*ends, bridge, *anchors, loop[0], joint("prismatic", "b", "bridge", "<axis/>", "rail"))
    assert [(diagnostic.code, str(diagnostic.message)) for diagnostic in simulation.scene.diagnostics] == [
        ("SIM118", "joint 'rail' is left out: a joint of type prismatic cannot close a loop")
    ]


def test_circular_and_dangling_joints_are_ignored():
    parts = [box(name, f"{x} 0 9 0 0 0") for name, x in (("a", 0), ("b", 2))]
    joints = [joint("fixed", "a", "b", name="on"), joint("fixed", "b", "a", name="back"), joint("fixed", "a", "nobody")]
    simulation = make_simulation(*parts, *joints, gravity="0 0 -10")
    simulation.advance(500_000_000)
    assert simulation.model_pose("a")[2] == pytest.approx(9 - 1.25, abs=0.01)
    assert simulation.model_pose("b")[2] == pytest.approx(9 - 1.25, abs=0.01)


def test_world_joints_support_mimic_and_gearbox():
    wheels = [box(name, f"{x} 0 3 0 0 0", "0.2 0.2 0.2") for name, x in (("base", 0), ("a", 1), ("b", 2), ("c", 3))]
    axis = "<axis><xyz>0 0 1</xyz>{}</axis>"
    follow = axis.format('<mimic joint="turn_a"><multiplier>2</multiplier></mimic>')
    gear = "<gearbox_ratio>3</gearbox_ratio><gearbox_reference_body>base</gearbox_reference_body>"
    joints = (
        joint("fixed", "world", "base", name="anchor"),
        joint("revolute", "base", "a", axis.format(""), "turn_a"),
        joint("revolute", "base", "b", follow, "turn_b"),
        joint("revolute", "base", "c", axis.format(""), "turn_c"),
        joint("gearbox", "a", "c", gear + axis.format("") + axis.format("").replace("axis>", "axis2>"), "gear"),
    )
    simulation = make_simulation(*wheels, *joints)
    simulation.push_joint("turn_a", 0.05)
    simulation.advance(1_500_000_000)
    angle = simulation.joint_state("turn_a")[0]
    assert angle > 0.3
    assert simulation.joint_state("turn_b")[0] == pytest.approx(2 * angle, rel=0.01)
    assert simulation.joint_state("turn_c")[0] == pytest.approx(-3 * angle, rel=0.01)


def test_sensor_in_world_joint_is_reported_as_unsimulated():
    sensor = '<sensor name="force" type="force_torque"/>'
    simulation = make_simulation(box("a", "0 0 9 0 0 0"), joint("fixed", "world", "a", sensor))
    assert find_unsimulated_elements(simulation.world) == ["<sensor> in <joint> of <world>"]


async def test_attached_model_falls_when_its_parent_is_deleted(tmp_path):
    parts = box("base", "0 0 9 0 0 0"), box("load", "0 0 7.5 0 0 0")
    joints = joint("fixed", "world", "base", name="anchor"), joint("fixed", "base", "load", name="rope")
    async with simulator(tmp_path, *parts, *joints) as session:
        simulation = session.simulator.server.simulation
        await step_simulation(session, 200)
        assert simulation.model_pose("load")[2] == 7.5
        await session.call("gazebo_msgs/srv/DeleteEntity", "/delete_entity", name="base")
        assert simulation.model_pose("load")[2] == 7.5
        await step_simulation(session, 200)
        assert simulation.model_pose("load")[2] == pytest.approx(7.5 - 0.5 * 9.8 * 0.04, abs=0.01)
        await session.call("std_srvs/srv/Empty", "/reset_world")
        assert simulation.model_pose("load")[2] == 7.5


async def test_load_world_updates_world_joints(tmp_path):
    base, bob = box("base", "0 0 9 0 0 0"), BAR.format(name="bob", pose="1 0 9 0 0 0")
    anchor = joint("fixed", "world", "base", name="anchor")
    swing = joint("revolute", "base", "bob", HINGE.format(at="base"), name="swing")
    async with simulator(tmp_path, base, bob, anchor, swing) as session:
        simulation = session.simulator.server.simulation
        await step_simulation(session, 300)
        swing_state = simulation.joint_state("swing")
        assert swing_state[0] > 0.1
        await load_world(session, tmp_path, base.replace("<mass>", "<mass>1"), bob, anchor, swing)
        assert simulation.joint_state("swing") == swing_state, "a model on a changed model keeps moving"
        await load_world(session, tmp_path, box("base", "3 0 9 0 0 0"), bob.replace("1 0 9", "4 0 9"), anchor, swing)
        assert simulation.model_pose("base")[:3] == (3, 0, 9)
        assert simulation.joint_state("swing") == swing_state
        await load_world(session, tmp_path, base, bob, anchor)
        assert simulation.moves_freely("bob")
        await load_world(session, tmp_path, base, bob, anchor, swing)
        assert not simulation.moves_freely("bob")


def test_joint_with_child_fixed_to_world_holds_parent():
    simulation = make_simulation(box("crate", "0 0 2 0 0 0"), joint("ball", "crate", "pin"), '<frame name="pin"/>')
    simulation.advance(500_000_000)
    assert simulation.model_pose("crate")[:3] == pytest.approx((0, 0, 2), abs=1e-3)
