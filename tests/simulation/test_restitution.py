"""Bouncing bodies, and the height of their bounces."""

from __future__ import annotations

from itertools import pairwise
from math import sqrt

import pytest

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.simulation import Simulation
from tests.simulation.worlds import make_simulation

MILLISECOND = NANOSECONDS_PER_SECOND // 1000
BALL_RADIUS = 0.1
GRAVITY = 9.81
BALL = f"<sphere><radius>{BALL_RADIUS}</radius></sphere>"
BLOCK = "<box><size>0.2 0.2 0.2</size></box>"


def bounce_surface_element(coefficient: float, extra: str = "") -> str:
    return (
        f"<surface><bounce><restitution_coefficient>{coefficient}</restitution_coefficient>{extra}</bounce></surface>"
        if coefficient
        else ""
    )


def floor_model(coefficient: float = 1.0) -> str:
    return (
        '<model name="floor"><static>true</static><link name="l"><collision name="c"><geometry><plane>'
        f"<normal>0 0 1</normal></plane></geometry>{bounce_surface_element(coefficient)}</collision></link></model>"
    )


def bouncing_model(
    pose: str, coefficient: float, shape: str = BALL, mass: float = 2.0, extra: str = "", name: str = "b"
) -> str:
    moment = 0.4 * mass * BALL_RADIUS**2
    return (
        f'<model name="{name}"><pose>{pose}</pose><link name="l"><inertial><mass>{mass}</mass><inertia>'
        f"<ixx>{moment}</ixx><iyy>{moment}</iyy><izz>{moment}</izz></inertia></inertial>"
        f'<collision name="c"><geometry>{shape}</geometry>{bounce_surface_element(coefficient, extra)}</collision>'
        "</link></model>"
    )


def record_heights(simulation: Simulation, milliseconds: int) -> list[float]:
    link_heights = []
    for _ in range(milliseconds):
        simulation.advance(MILLISECOND)
        link_heights.append(simulation.link_pose("b::l")[2] - BALL_RADIUS)
    return link_heights


def measure_bounce_height(simulation: Simulation, height: float) -> float:
    """Return the height that a model reaches after its first impact."""
    fall = sqrt(2 * height / GRAVITY) + 0.005
    while simulation.seconds < fall:
        simulation.advance(MILLISECOND)
    highest = 0.0
    while simulation.seconds < 2 * fall:
        highest = max(highest, record_heights(simulation, 1)[0])
    return highest


@pytest.mark.parametrize("step", [0.0005, 0.001, 0.002])
@pytest.mark.parametrize("shape", [BALL, BLOCK])
@pytest.mark.parametrize("height", [0.3, 1.0, 3.0])
@pytest.mark.parametrize("coefficient", [0.2, 0.5, 0.9])
def test_bounce_height_matches_restitution_coefficient(coefficient: float, height: float, shape: str, step: float):
    simulation = make_simulation(
        floor_model(), bouncing_model(f"0 0 {height + BALL_RADIUS} 0 0 0", coefficient, shape), step=step
    )
    assert measure_bounce_height(simulation, height) == pytest.approx(coefficient**2 * height, rel=0.05)


def test_restitution_of_two_surfaces_is_their_product():
    start = f"0 0 {1 + BALL_RADIUS} 0 0 0"
    assert sqrt(
        measure_bounce_height(make_simulation(floor_model(0.8), bouncing_model(start, 0.8)), 1.0)
    ) == pytest.approx(0.64, abs=0.02)
    assert measure_bounce_height(make_simulation(floor_model(0.0), bouncing_model(start, 0.8)), 1.0) < 0.01
    slow = bouncing_model(start, 0.8, extra="<threshold>6</threshold>")  # the impact speed is 4.4 m/s
    assert measure_bounce_height(make_simulation(floor_model(), slow), 1.0) < 0.01


def test_bouncing_body_comes_to_rest():
    simulation = make_simulation(floor_model(), bouncing_model(f"0 0 {0.3 + BALL_RADIUS} 0.2 0.3 0", 0.5, BLOCK))
    assert max(abs(b - a) for a, b in pairwise(record_heights(simulation, 5000)[-1000:])) < 1e-6
    assert simulation.link_pose("b::l")[2] == pytest.approx(BALL_RADIUS, abs=1e-3)


def test_obliquely_bouncing_ball_starts_rolling():
    simulation = make_simulation(floor_model(), bouncing_model(f"0 0 {1 + BALL_RADIUS} 0 0 0", 0.5))
    simulation.set_model_velocity("b", (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    record_heights(simulation, 600)
    (x, _, _), (_, rate, _) = simulation.link_velocity("b::l")
    assert x == pytest.approx(5 / 7, abs=0.01)  # a solid ball, without slipping
    assert rate == pytest.approx(x / BALL_RADIUS, rel=0.03)


def test_equal_balls_exchange_velocities():
    simulation = make_simulation(
        bouncing_model("0 0 1 0 0 0", 1.0, name="a"), bouncing_model("0.5 0 1 0 0 0", 1.0, name="b"), gravity="0 0 0"
    )
    simulation.set_model_velocity("a", (2.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    simulation.advance(400 * MILLISECOND)
    speeds = [simulation.link_velocity(f"{name}::l")[0][0] for name in "ab"]
    assert speeds == pytest.approx([0.0, 2.0], abs=0.02)


def test_bounces_are_bitwise_reproducible():
    def run() -> bytes:
        simulation = make_simulation(floor_model(), bouncing_model("0 0 0.7 0.3 0.2 0", 0.8, BLOCK))
        simulation.advance(NANOSECONDS_PER_SECOND)
        return bytes(simulation.data.qpos.tobytes())

    assert run() == run()
