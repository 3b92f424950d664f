"""Screws, gears, and kinematic links."""

from __future__ import annotations

from math import tau

import pytest

from tests.simulation.worlds import box, make_simulation

SECOND_NS = 1_000_000_000
BODY = "<inertial><mass>1</mass><inertia><ixx>.1</ixx><iyy>.1</iyy><izz>.1</izz></inertia></inertial>"


def wheel_model(name: str, y: float, axis: str) -> str:
    """Return a wheel on a fixed axle."""
    return (
        f'<link name="{name}"><pose>0 {y} 0 0 0 0</pose>{BODY}</link><joint name="{name}_axle" type="revolute">'
        f"<parent>world</parent><child>{name}</child><axis><xyz>{axis}</xyz></axis></joint>"
    )


def geared_wheels(ratio: float, axis: str = "1 0 0", gearbox_first: bool = False) -> str:
    gearbox = (
        '<joint name="gears" type="gearbox"><parent>a</parent><child>b</child>'
        f"<gearbox_ratio>{ratio}</gearbox_ratio><gearbox_reference_body>world</gearbox_reference_body>"
        "<axis><xyz>1 0 0</xyz></axis><axis2><xyz>1 0 0</xyz></axis2></joint>"
    )
    wheels = wheel_model("a", 0, "1 0 0") + wheel_model("b", 1, axis)
    return f'<model name="m">{gearbox + wheels if gearbox_first else wheels + gearbox}</model>'


@pytest.mark.parametrize("gearbox_first", [True, False])
@pytest.mark.parametrize(("axis", "ratio"), [("1 0 0", 1.5), ("-1 0 0", -1.5)])
def test_gearbox_child_turns_by_negative_ratio(axis, ratio, gearbox_first):
    simulation = make_simulation(geared_wheels(-1.5, axis, gearbox_first))
    simulation.push_joint("m::a_axle", 1.0)
    simulation.advance(SECOND_NS)
    angle, _ = simulation.joint_state("m::a_axle")
    assert angle > 0.1
    assert simulation.joint_state("m::b_axle")[0] == pytest.approx(ratio * angle, abs=1e-3)


def test_screw_joint_moves_by_pitch_per_revolution():
    screw = (
        f'<model name="m"><link name="nut">{BODY}</link><joint name="screw" type="screw"><parent>world</parent>'
        "<child>nut</child><screw_thread_pitch>0.01</screw_thread_pitch><axis><xyz>0 0 1</xyz></axis></joint></model>"
    )
    simulation = make_simulation(screw, gravity="0 0 0")
    simulation.push_joint("m::screw", 1.0)
    simulation.advance(SECOND_NS)
    angle, _ = simulation.joint_state("m::screw")
    assert angle > 1.0
    assert simulation.link_pose("m::nut")[2] == pytest.approx(0.01 * angle / tau, abs=1e-4)


def test_kinematic_model_keeps_pose_and_pushes_others():
    shape = '<collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision>'
    lift = f'<model name="lift"><pose>0 0 0.5 0 0 0</pose><link name="l"><kinematic>1</kinematic>{shape}</link></model>'
    simulation = make_simulation(lift, box("crate", pose="0 0 1.5 0 0 0"))
    simulation.advance(SECOND_NS // 10)
    assert simulation.model_pose("lift")[:3] == pytest.approx((0, 0, 0.5))
    simulation.set_model_pose("lift", (0.0, 0.0, 0.52, 0.0, 0.0, 0.0, 1.0))
    simulation.advance(SECOND_NS)
    assert simulation.model_pose("lift")[:3] == pytest.approx((0, 0, 0.52))
    assert simulation.model_pose("crate")[2] == pytest.approx(1.52, abs=5e-3)
