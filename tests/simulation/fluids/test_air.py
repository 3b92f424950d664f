"""Wings and wind."""

from __future__ import annotations

from math import atan, cos, exp, radians, sin, sqrt

import numpy as np
import pytest

from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import box

AIR_DENSITY = 1.2041


def wing_plugin(parameters: str, filename: str = "gz-sim-lift-drag-system", pitch: float = 0.0) -> str:
    plugin = f'<plugin name="wing" filename="{filename}"><link_name>link</link_name>{parameters}</plugin>'
    return box("glider", f"0 0 100 0 {pitch} 0", mass=1000.0).replace("</model>", f"{plugin}</model>")


async def measure_force(text: str, velocity: tuple[float, float, float], **joints: float) -> np.ndarray:
    """Return the force in N on a glider with a velocity."""
    async with running_server(text) as (server, _, log):
        simulation = server.simulation
        for joint, position in joints.items():
            simulation.set_joint_position(f"glider::{joint}", position)
        simulation.set_model_velocity("glider", velocity, (0.0, 0.0, 0.0))
        server.advance(SECOND_NS // 1000)
        force = simulation.data.body("glider::link").xfrc_applied.copy()
        assert not log
        return force


@pytest.mark.parametrize("filename", ["gz-sim-lift-drag-system", "libLiftDragPlugin.so"])
async def test_lift_and_drag_follow_angle_of_attack(filename):
    attack = 0.1
    force = await measure_force(
        wing_plugin("<cla>5</cla><cda>0.5</cda><area>2</area>", filename, pitch=-attack), (20.0, 0.0, 0.0)
    )
    pressure = 0.5 * AIR_DENSITY * 400.0 * 2.0
    assert force[2] == pytest.approx(pressure * 5 * attack, rel=0.02)
    assert force[0] == pytest.approx(-pressure * 0.5 * attack, rel=0.02)


async def test_lift_falls_after_stall():
    parameters = "<cla>5</cla><alpha_stall>0.3</alpha_stall><cla_stall>-4</cla_stall><cda_stall>2</cda_stall>"
    pressure = 0.5 * AIR_DENSITY * 400.0
    force = await measure_force(wing_plugin(parameters, pitch=-0.5), (20.0, 0.0, 0.0))
    assert force[2] == pytest.approx(pressure * (5 * 0.3 - 4 * 0.2), rel=0.05)
    assert force[0] == pytest.approx(-pressure * (0.01 * 0.3 + 2 * 0.2), rel=0.05)
    force = await measure_force(wing_plugin(parameters, pitch=-1.0), (20.0, 0.0, 0.0))
    assert force[2] == pytest.approx(0.0, abs=1.0)  # 1.5 - 2.8 is limited to zero


async def test_area_density_zero_lift_angle_and_sweep():
    force = await measure_force(
        wing_plugin("<cla>5</cla><a0>0.1</a0><area>3</area><air_density>1</air_density>"), (10.0, 10.0, 0.0)
    )
    assert force[2] == pytest.approx(0.5 * 100.0 * 3.0 * 5.0 * 0.1 * 0.5, rel=0.03)  # cos2 of a sweep of 45 degrees


async def test_wing_that_moves_backward_or_rests_has_no_force():
    for velocity in ((-20.0, 0.0, 0.0), (0.0, 0.0, 0.0)):
        assert await measure_force(wing_plugin("<a0>0.2</a0>"), velocity) == pytest.approx(np.zeros(6), abs=1e-9)


async def test_force_at_center_of_pressure_turns_glider():
    force = await measure_force(wing_plugin("<cla>5</cla><a0>0.1</a0><cp>-0.5 0 0</cp>"), (20.0, 0.0, 0.0))
    assert force[4] == pytest.approx(0.5 * force[2], rel=0.01)


async def test_control_joint_adds_lift():
    flap = (
        '<link name="flap"><inertial><mass>0.1</mass></inertial></link><joint name="hinge" type="revolute">'
        "<parent>link</parent><child>flap</child><axis><xyz>0 1 0</xyz></axis></joint>"
    )
    parameters = "<control_joint_name>hinge</control_joint_name><control_joint_rad_to_cl>3</control_joint_rad_to_cl>"
    text = wing_plugin(parameters).replace("</model>", f"{flap}</model>")
    force = await measure_force(text, (20.0, 0.0, 0.0), hinge=0.2)
    assert force[2] == pytest.approx(0.5 * AIR_DENSITY * 400.0 * 3 * 0.2, rel=0.05)


async def test_symmetric_body_is_lifted_across_its_velocity():
    force = await measure_force(wing_plugin("<cla>2</cla><radial_symmetry>true</radial_symmetry>"), (20.0, 2.0, 0.0))
    assert force[1] == pytest.approx(-0.5 * AIR_DENSITY * 404.0 * 2 * atan(0.1), rel=0.02)
    assert force[2] == pytest.approx(0.0, abs=0.5)


def glide(step: float, duration: float, mass: float, *, has_first_force: bool) -> np.ndarray:
    """Return the position in m and the velocity in m/s, x and z, of a level wing after a glide of semi-implicit steps.

    Its lift and drag coefficients are 5 and 0.5 per rad at an angle of 0.05 rad, its area is 0.2 m2.
    """
    position, velocity = np.zeros(2), np.array((20.0, 0.0))
    for number in range(round(duration / step)):
        force, speed = np.zeros(2), float(np.hypot(*velocity))
        if number or has_first_force:
            direction = velocity / speed
            angle = 0.05 - float(np.arctan2(velocity[1], velocity[0]))
            pressure = 0.5 * AIR_DENSITY * 0.2 * speed**2
            force = pressure * angle * (5.0 * np.array((-direction[1], direction[0])) - 0.5 * direction)
        velocity = velocity + step * (force / mass - (0.0, 9.81))
        position = position + step * velocity
    return np.concatenate((position, velocity))


@pytest.mark.parametrize("step", [0.001, 0.002])
async def test_free_wing_glides_as_formula_says(step):
    """The steps are those of the formula; as in gz, a velocity that is set has no effect on the force of its own step.

    This first step without a force is worth 1.4 mm within 0.2 s at steps of 1 ms, and the length of the step 0.2 mm.
    """
    mass, duration = 2.0, 0.2
    text = wing_plugin("<cla>5</cla><cda>0.5</cda><area>0.2</area><a0>0.05</a0>").replace("1000.0", str(mass))
    async with running_server(text, step=step) as (server, _, log):
        simulation = server.simulation
        simulation.set_model_velocity("glider", (20.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        server.advance(round(duration * SECOND_NS))
        x, _, z, *_ = simulation.link_pose("glider::link")
        linear, _ = simulation.link_velocity("glider::link")
        state = np.array((x, z - 100.0, linear[0], linear[2]))
        assert not log
    assert state == pytest.approx(glide(step, duration, mass, has_first_force=False), abs=1e-6)
    limit = glide(1e-5, duration, mass, has_first_force=True)
    assert state[:2] == pytest.approx(limit[:2], abs=1.3 * step)


# --- wind -------------------------------------------------------------------------------------------------------------


def windy_world(parameters: str = "", wind: str = "3 4 1", filename: str = "gz-sim-wind-effects-system") -> str:
    return (
        f"<wind><linear_velocity>{wind}</linear_velocity></wind>"
        f'<plugin name="wind" filename="{filename}">{parameters}</plugin>'
    )


def kite_model(name: str = "kite") -> str:
    return box(name, "0 0 100 0 0 0", mass=2.0).replace("<link ", "<enable_wind>true</enable_wind><link ")


@pytest.mark.parametrize("filename", ["gz-sim-wind-effects-system", "libWindPlugin.so"])
async def test_wind_rises_and_pushes_only_enabled_links(filename):
    parameters = (
        "<horizontal><magnitude><time_for_rise>2</time_for_rise></magnitude></horizontal>"
        "<vertical><time_for_rise>4</time_for_rise></vertical>"
    )
    parts = windy_world(parameters, filename=filename), kite_model(), box("stone", "5 0 100 0 0 0", mass=2.0)
    async with running_server(*parts) as (server, _, log):
        server.advance(SECOND_NS)
        magnitude = 5.0 * (1 - exp(-0.5))
        assert server.simulation.wind == pytest.approx((0.6 * magnitude, 0.8 * magnitude, 1 - exp(-0.25)), rel=0.01)
        velocity, _ = server.simulation.link_velocity("stone::link")
        assert velocity[:2] == pytest.approx((0.0, 0.0), abs=1e-9)
        server.advance(30 * SECOND_NS)
        velocity, _ = server.simulation.link_velocity("kite::link")
        assert velocity[:2] == pytest.approx((3.0, 4.0), rel=0.01)
        assert velocity[2] == pytest.approx(1.0 - 9.81, rel=0.01)  # the wind carries, gravity pulls
        assert not log


async def test_force_grows_with_factor():
    parts = (
        windy_world("<force_approximation_scaling_factor>3</force_approximation_scaling_factor>", "0 0 9.81"),
        kite_model(),
    )
    async with running_server(*parts) as (server, _, __):
        server.advance(30 * SECOND_NS)
        velocity, _ = server.simulation.link_velocity("kite::link")
        assert velocity[2] == pytest.approx(9.81 - 9.81 / 3, rel=0.01)


async def test_sine_and_noise_vary_magnitude_and_direction():
    parameters = (
        "<horizontal><magnitude><time_for_rise>0.01</time_for_rise><sin><amplitude_percent>0.5</amplitude_percent>"
        "<period>4</period></sin></magnitude><direction><time_for_rise>0.01</time_for_rise><sin><amplitude>30</amplitude>"
        "<period>4</period></sin></direction></horizontal>"
    )
    async with running_server(windy_world(parameters, "2 0 0")) as (server, _, __):
        server.advance(SECOND_NS)
        assert server.simulation.wind[:2] == pytest.approx((3 * cos(radians(30)), 3 * sin(radians(30))), rel=0.01)
    noise = '<vertical><noise type="gaussian"><mean>1</mean><stddev>0.5</stddev></noise></vertical>'
    winds: list[list[float]] = []
    for _ in range(2):
        async with running_server(windy_world(noise, "0 0 0")) as (server, _, __):
            winds.append([])
            for _ in range(1000):
                server.advance(SECOND_NS // 1000)
                winds[-1].append(server.simulation.wind[2])
    assert winds[0] == winds[1], "the same seed gives the same wind"
    assert np.mean(winds[0]) == pytest.approx(1.0, abs=4 * 0.5 / sqrt(1000))
    assert np.std(winds[0]) == pytest.approx(0.5, rel=0.1)


async def test_wind_lifts_wing_at_rest():
    rise = "<horizontal><magnitude><time_for_rise>0.001</time_for_rise></magnitude></horizontal>"
    parts = windy_world(rise, "-20 0 0"), wing_plugin("<cla>5</cla><a0>0.1</a0>")
    async with running_server(*parts, gravity="0 0 0") as (server, _, __):
        server.advance(SECOND_NS // 50)
        force = server.simulation.data.body("glider::link").xfrc_applied
        assert force[2] == pytest.approx(0.5 * AIR_DENSITY * 400.0 * 0.5, rel=0.02)


async def test_time_constant_of_zero_is_reported():
    parameters = "<horizontal><magnitude><time_for_rise>0</time_for_rise></magnitude></horizontal>"
    async with running_server(windy_world(parameters)) as (_, __, log):
        assert any("<time_for_rise> and <period> of <magnitude> must be greater than 0" in r.text for r in log)


async def test_wind_of_world_alone_lifts_wing():
    text = "<wind><linear_velocity>-20 0 0</linear_velocity></wind>" + wing_plugin("<cla>5</cla><a0>0.1</a0>")
    force = await measure_force(text, (0.0, 0.0, 0.0))
    assert force[2] == pytest.approx(0.5 * AIR_DENSITY * 400.0 * 0.5, rel=0.02)


async def test_wings_of_one_link_add_up():
    """The forces of several wings of one link add up.

    Descriptions of planes give both halves of a wing to one link, often with plugins of the same name.
    """
    wing_of_half_area = (
        '<plugin name="wing" filename="gz-sim-lift-drag-system"><link_name>link</link_name><cla>5</cla><a0>0.1</a0>'
    )
    text = wing_plugin("<cla>5</cla><a0>0.1</a0><cp>0 1 0</cp>").replace(
        "</model>", f"{wing_of_half_area}<cp>0 -1 0</cp></plugin></model>"
    )
    force = await measure_force(text, (20.0, 0.0, 0.0))
    assert force[2] == pytest.approx(2 * 0.5 * AIR_DENSITY * 400.0 * 0.5, rel=0.02)
    assert force[3] == pytest.approx(0.0, abs=1.0)
