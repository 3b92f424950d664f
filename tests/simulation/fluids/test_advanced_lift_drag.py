"""Airplanes by their stability derivatives: forces and moments against the formulas."""

from __future__ import annotations

from math import cos, exp, pi, radians, sin, sqrt

import numpy as np
import pytest

from linkwright.simulation.server.server import ServerOptions
from tests.simulation.fluids.test_air import AIR_DENSITY
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import box

SPEED = 20.0
AREA, ASPECT_RATIO, EFFICIENCY = 2.0, 8.0, 0.9
SPAN = sqrt(AREA * ASPECT_RATIO)
CHORD = AREA / SPAN
PRESSURE = 0.5 * AIR_DENSITY * SPEED**2 * AREA
LIBRARIES = ["gz-sim-advanced-lift-drag-system", "libAdvancedLiftDragPlugin.so"]
ELEVATOR = (
    '<link name="flap"><inertial><mass>0.1</mass></inertial></link><joint name="hinge" type="revolute">'
    "<parent>link</parent><child>flap</child><axis><xyz>0 1 0</xyz></axis></joint>"
)


def airplane(derivatives: str, filename: str = LIBRARIES[0], pitch: float = 0.0, parts: str = "") -> str:
    plugin = (
        f'<plugin name="wing" filename="{filename}"><link_name>link</link_name><area>{AREA}</area>'
        f"<AR>{ASPECT_RATIO}</AR><eff>{EFFICIENCY}</eff>{derivatives}</plugin>"
    )
    return box("plane", f"0 0 100 0 {pitch} 0", mass=1000.0).replace("</model>", f"{parts}{plugin}</model>")


async def measure_wrench(
    text: str,
    velocity: tuple[float, float, float] = (SPEED, 0.0, 0.0),
    rates: tuple[float, float, float] = (0.0, 0.0, 0.0),
    hinge: float = 0.0,
    options: ServerOptions | None = None,
) -> np.ndarray:
    """Return the force in N and the torque in N m on an airplane with a velocity and turning rates."""
    async with running_server(text, options=options) as (server, _, log):
        simulation = server.simulation
        if hinge:
            simulation.set_joint_position("plane::hinge", hinge)
        simulation.set_model_velocity("plane", velocity, rates)
        server.advance(SECOND_NS // 1000)
        wrench = simulation.data.body("plane::link").xfrc_applied.copy()
        assert not log
        return wrench


@pytest.mark.parametrize("filename", LIBRARIES)
async def test_lift_induces_drag(filename):
    derivatives = "<CL0>0.2</CL0><CLa>5</CLa><CD0>0.03</CD0><alpha_stall>0.6</alpha_stall>"
    force = await measure_wrench(airplane(derivatives, filename, pitch=-0.1))
    lift = 0.2 + 5 * 0.1
    assert force[2] == pytest.approx(PRESSURE * lift, rel=0.01)
    assert force[0] == pytest.approx(-PRESSURE * (0.03 + lift**2 / (pi * ASPECT_RATIO * EFFICIENCY)), rel=0.02)


async def test_stalled_wing_is_a_flat_plate():
    force = await measure_wrench(airplane("<CLa>5</CLa><alpha_stall>0.3</alpha_stall>", pitch=-1.0))
    assert force[2] == pytest.approx(PRESSURE * 2 * sin(1.0) ** 2 * cos(1.0), rel=0.02)
    plate = 2.0 / (1.0 + exp(-0.224 - 0.115 * ASPECT_RATIO))
    assert force[0] == pytest.approx(-PRESSURE * plate * sin(1.0) ** 2, rel=0.02)


async def test_sideslip_pushes_to_the_side_and_turns_the_nose():
    slip = radians(5)
    velocity = SPEED * cos(slip), -SPEED * sin(slip), 0.0
    wrench = await measure_wrench(airplane("<CYb>-0.4</CYb><Cenb>0.1</Cenb><Cellb>-0.05</Cellb>"), velocity)
    pressure = PRESSURE * cos(slip) ** 2
    assert wrench[1] == pytest.approx(pressure * 0.4 * slip, rel=0.02)  # to the left: it slips to the right
    assert wrench[3] == pytest.approx(-pressure * SPAN * 0.05 * slip, rel=0.02)  # rolls to the left
    assert wrench[5] == pytest.approx(-pressure * SPAN * 0.1 * slip, rel=0.02)  # the nose turns to the right


async def test_rates_are_damped():
    wrench = await measure_wrench(airplane("<Cellp>-0.5</Cellp><Cemq>-10</Cemq>"), rates=(0.3, 0.2, 0.0))
    assert wrench[3] == pytest.approx(-PRESSURE * SPAN * 0.5 * 0.3 * SPAN / 2 / SPEED, rel=0.02)
    assert wrench[4] == pytest.approx(-PRESSURE * CHORD * 10 * 0.2 * CHORD / 2 / SPEED, rel=0.02)


async def test_control_surface_pitches_by_its_angle_in_degrees():
    surface = (
        "<control_surface><name>hinge</name><direction>-1</direction><CL_ctrl>0.01</CL_ctrl>"
        "<Cem_ctrl>-0.02</Cem_ctrl></control_surface>"
    )
    wrench = await measure_wrench(airplane(surface, parts=ELEVATOR), hinge=radians(5))
    assert wrench[2] == pytest.approx(-PRESSURE * 0.05, rel=0.03)
    assert wrench[4] == pytest.approx(-PRESSURE * CHORD * 0.1, rel=0.03)  # nose up is negative about y


@pytest.mark.parametrize(
    ("filename", "is_kept"), [(LIBRARIES[0], False), (LIBRARIES[1], True)], ids=["gz", "Gazebo Classic"]
)
async def test_gz_drops_the_pitching_moment_only_as_a_known_mistake(filename, is_kept):
    text = airplane("<Cem0>0.1</Cem0><Cema>-0.5</Cema>", filename)
    expected = -PRESSURE * CHORD * 0.1
    assert (await measure_wrench(text))[4] == pytest.approx(expected, rel=0.02)
    with_mistakes = await measure_wrench(text, options=ServerOptions(gazebo_mistakes=True))
    assert with_mistakes[4] == pytest.approx(expected if is_kept else 0.0, rel=0.02)


async def test_wing_without_aspect_ratio_is_told_of():
    async with running_server(airplane("").replace("<AR>8.0</AR>", "")) as (_, __, log):
        assert "<AR>, <eff> and <area> must be positive" in log[0].text
