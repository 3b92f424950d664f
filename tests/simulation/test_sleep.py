"""Sleeping bodies: slow motion does not fall asleep, and bodies at rest do."""

from __future__ import annotations

from math import cos, pi, sin, sqrt

import pytest

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.simulation import Simulation
from tests.simulation.worlds import GROUND, box, make_simulation

NO_GRAVITY = "0 0 0"


def pendulum_model(*, stiffness: float = 0.0, damping: float = 0.0, kind: str = "revolute", axis: str = "0 1 0") -> str:
    """Return a bob of 1 kg, 1 m below a fixed joint."""
    spring = f"<spring_stiffness>{stiffness}</spring_stiffness><spring_reference>0</spring_reference>"
    inertia = "<inertia><ixx>1e-6</ixx><iyy>1e-6</iyy><izz>1e-6</izz></inertia>"
    return (
        '<model name="swing"><pose>0 0 3 0 0 0</pose><link name="base"/>'
        f'<link name="bob"><pose>0 0 -1 0 0 0</pose><inertial><mass>1</mass>{inertia}</inertial></link>'
        '<joint name="post" type="fixed"><parent>world</parent><child>base</child></joint>'
        f'<joint name="joint" type="{kind}"><pose>0 0 1 0 0 0</pose><parent>base</parent><child>bob</child>'
        f"<axis><xyz>{axis}</xyz><dynamics><damping>{damping}</damping>{spring}</dynamics></axis></joint></model>"
    )


def are_asleep(simulation: Simulation) -> bool:
    return bool((simulation.data.tree_asleep >= 0).all())


@pytest.mark.parametrize("amplitude", [0.1, 0.02, 0.005, 0.001])
def test_pendulum_keeps_swinging(amplitude: float):
    simulation = make_simulation(pendulum_model())
    simulation.set_joint_position("swing::joint", amplitude)
    half_period = round(pi / sqrt(9.81) * NANOSECONDS_PER_SECOND)
    simulation.advance(9 * half_period)
    assert simulation.joint_state("swing::joint")[0] == pytest.approx(-amplitude, rel=0.01)


@pytest.mark.parametrize("damping", [2.0, 40.0])
def test_mass_on_spring_rests_at_equilibrium(damping: float):
    simulation = make_simulation(pendulum_model(kind="prismatic", axis="0 0 1", stiffness=100.0, damping=damping))
    simulation.advance(15 * NANOSECONDS_PER_SECOND)
    assert simulation.joint_state("swing::joint")[0] == pytest.approx(-0.0981, abs=1e-5)
    assert are_asleep(simulation)


@pytest.mark.parametrize("gravity", [0.05, 0.002])
def test_bodies_fall_under_tiny_gravity(gravity: float):
    simulation = make_simulation(box("crate", "0 0 5 0 0 0"), gravity=f"0 0 {-gravity}")
    simulation.advance(2 * NANOSECONDS_PER_SECOND)
    assert 5.0 - simulation.link_pose("crate::link")[2] == pytest.approx(2 * gravity, rel=0.01)


def test_ball_rolls_down_tiny_slope():
    slope = 0.0005
    ball = (
        '<model name="ball"><pose>0 0 0.1 0 0 0</pose><link name="link"><inertial><mass>1</mass>'
        "<inertia><ixx>0.004</ixx><iyy>0.004</iyy><izz>0.004</izz></inertia></inertial>"
        '<collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link></model>'
    )
    simulation = make_simulation(GROUND, ball, gravity=f"{9.81 * sin(slope)} 0 {-9.81 * cos(slope)}")
    simulation.advance(4 * NANOSECONDS_PER_SECOND)
    assert simulation.link_velocity("ball::link")[0][0] == pytest.approx(5 / 7 * 9.81 * slope * 4, rel=0.01)


@pytest.mark.parametrize("speed", [1.0, 1e-4])
def test_sleeping_body_moves_when_velocity_is_set(speed: float):
    simulation = make_simulation(box("crate", "0 0 5 0 0 0"), gravity=NO_GRAVITY)
    simulation.advance(NANOSECONDS_PER_SECOND)
    assert are_asleep(simulation)
    simulation.set_model_velocity("crate", (speed, 0.0, 0.0), (0.0, 0.0, speed))
    simulation.advance(2 * NANOSECONDS_PER_SECOND)
    assert simulation.link_pose("crate::link")[0] == pytest.approx(2 * speed)


@pytest.mark.parametrize("force", [10.0, 1e-3])
def test_sleeping_body_moves_when_pushed(force: float):
    simulation = make_simulation(box("crate", "0 0 5 0 0 0", mass=1.0), gravity=NO_GRAVITY)
    simulation.advance(NANOSECONDS_PER_SECOND)
    simulation.push("crate::link", (force, 0.0, 0.0))
    simulation.advance(NANOSECONDS_PER_SECOND)
    assert simulation.link_pose("crate::link")[0] == pytest.approx(force / 2, rel=0.01)


def test_sleeping_body_falls_when_gravity_is_set():
    simulation = make_simulation(box("crate", "0 0 5 0 0 0"), gravity=NO_GRAVITY)
    simulation.advance(NANOSECONDS_PER_SECOND)
    simulation.set_gravity((0.0, 0.0, -0.01))
    simulation.advance(2 * NANOSECONDS_PER_SECOND)
    assert 5.0 - simulation.link_pose("crate::link")[2] == pytest.approx(0.02, rel=0.01)


def test_stacked_boxes_fall_asleep_in_place():
    simulation = make_simulation(
        GROUND, *[box(f"b{index}", f"0 0 {0.1 + 0.2 * index} 0 0 0", "0.2 0.2 0.2") for index in range(4)]
    )
    simulation.advance(2 * NANOSECONDS_PER_SECOND)
    assert are_asleep(simulation)
    heights = simulation.data.qpos.copy()
    simulation.advance(10 * NANOSECONDS_PER_SECOND)
    assert (simulation.data.qpos == heights).all()


def test_box_falls_when_its_support_is_deleted():
    simulation = make_simulation(
        GROUND, box("lower", "0 0 0.1 0 0 0", "0.2 0.2 0.2"), box("upper", "0 0 0.3 0 0 0", "0.2 0.2 0.2")
    )
    simulation.advance(NANOSECONDS_PER_SECOND)
    assert are_asleep(simulation)
    simulation.delete("lower")
    simulation.advance(NANOSECONDS_PER_SECOND)
    assert simulation.link_pose("upper::link")[2] == pytest.approx(0.1, abs=1e-3)
