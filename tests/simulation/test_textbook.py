"""The motion of bodies and robots, compared with formulas of textbooks."""

from __future__ import annotations

import itertools
from math import atan, cos, hypot, pi, sin, sqrt

import pytest

from linkwright.geometry.single import rpy_from_quaternion
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.actuators import Motor
from linkwright.simulation.simulation import Simulation
from tests.simulation.worlds import GROUND, box, make_simulation, mbot

MILLISECOND = NANOSECONDS_PER_SECOND // 1000
GRAVITY = 9.81


def link_with_shape(mass: float, moment: float, geometry: str = "", surface: str = "") -> str:
    collision = f'<collision name="c"><geometry>{geometry}</geometry>{surface}</collision>' if geometry else ""
    return (
        f"<inertial><mass>{mass}</mass><inertia><ixx>{moment}</ixx><iyy>{moment}</iyy><izz>{moment}</izz></inertia>"
        f"</inertial>{collision}"
    )


def friction_element(mu: float) -> str:
    return f"<surface><friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction></surface>"


def slope_model(angle: float, mu: float = 1.0) -> str:
    """Return a plane that slopes down toward x."""
    return (
        '<model name="slope"><static>true</static><link name="l"><collision name="c"><geometry><plane>'
        f"<normal>{sin(angle)} 0 {cos(angle)}</normal></plane></geometry>{friction_element(mu)}"
        "</collision></link></model>"
    )


def test_pendulum_has_textbook_period():
    length, angle = 0.5, 0.1
    bob = link_with_shape(1.0, 1e-6)
    pendulum = f"""
    <model name="p"><pose>0 0 2 0 {angle} 0</pose>
      <link name="bob"><pose>0 0 -{length} 0 0 0</pose>{bob}</link>
      <joint name="hinge" type="revolute"><pose>0 0 {length} 0 0 0</pose><parent>world</parent><child>bob</child>
        <axis><xyz>0 1 0</xyz></axis></joint>
    </model>"""
    simulation = make_simulation(pendulum)
    crossings = []
    last = 0.0
    for _ in range(6000):
        simulation.advance(MILLISECOND)
        angle_now = simulation.joint_state("p::hinge")[0] + angle
        if last < 0.0 <= angle_now:
            crossings.append(simulation.seconds - 0.001 * angle_now / (angle_now - last))
        last = angle_now
    periods = [later - earlier for earlier, later in itertools.pairwise(crossings)]
    expected = 2 * pi * sqrt(length / GRAVITY) * (1 + angle**2 / 16)
    assert len(periods) >= 3
    assert periods == pytest.approx([expected] * len(periods), rel=1e-3)


@pytest.mark.parametrize(("mu", "slides"), [(0.4, True), (0.7, False)])
def test_block_on_slope_sticks_or_slides(mu, slides):
    angle = atan(0.5)
    height = 0.05 / cos(angle)
    simulation = make_simulation(
        slope_model(angle, mu), box("block", f"0 0 {height} 0 {angle} 0", "0.1 0.1 0.1", surface=friction_element(2.0))
    )
    simulation.advance(NANOSECONDS_PER_SECOND)
    x, _, z = simulation.model_pose("block")[:3]
    distance = hypot(x, z - height)
    if slides:
        assert distance == pytest.approx(GRAVITY * (sin(angle) - mu * cos(angle)) / 2, rel=0.05)
    else:
        assert distance < 2e-3


def test_ball_rolls_down_slope():
    angle, radius = 0.2, 0.1
    shape = f"<sphere><radius>{radius}</radius></sphere>"
    link = link_with_shape(1.0, 0.4 * radius**2, shape, friction_element(1.0))
    ball = f'<model name="ball"><pose>0 0 {radius / cos(angle)} 0 0 0</pose><link name="l">{link}</link></model>'
    simulation = make_simulation(slope_model(angle), ball)
    simulation.advance(NANOSECONDS_PER_SECOND)
    speed = simulation.link_velocity("ball::l")[0]
    assert hypot(*speed) == pytest.approx(5 / 7 * GRAVITY * sin(angle), rel=0.01)


def test_collision_conserves_momentum():
    simulation = make_simulation(
        box("one", "0 0 0 0 0 0", "0.2 0.2 0.2", 2.0), box("two", "1 0 0 0 0 0", "0.2 0.2 0.2", 1.0), gravity="0 0 0"
    )
    simulation.push("one::link", (20.0, 0.0, 0.0))
    simulation.advance(100 * MILLISECOND)
    simulation.push("one::link", (0.0, 0.0, 0.0))
    assert simulation.link_velocity("one::link")[0][0] == pytest.approx(1.0)
    simulation.advance(2 * NANOSECONDS_PER_SECOND)
    first, second = (simulation.link_velocity(f"{name}::link")[0][0] for name in ("one", "two"))
    assert second > 0.5
    assert 2.0 * first + 1.0 * second == pytest.approx(2.0, abs=1e-6)


def test_four_bar_linkage_stays_closed():
    bars = "".join(
        f'<link name="{name}"><pose>{pose}</pose>{link_with_shape(0.2, 1e-3)}</link>'
        for name, pose in (("crank", "0 0 1 0 0 0"), ("coupler", "0 0 1.3 0 0 0"), ("rocker", "0.5 0 1 0 0 0"))
    )
    joints = "".join(
        f'<joint name="{name}" type="revolute"><pose relative_to="{anchor}">{pose}</pose><parent>{parent}</parent>'
        f"<child>{child}</child><axis><xyz>0 1 0</xyz></axis></joint>"
        for name, anchor, pose, parent, child in (
            ("a", "crank", "0 0 0 0 0 0", "world", "crank"),
            ("b", "crank", "0 0 0.3 0 0 0", "crank", "coupler"),
            ("d", "rocker", "0 0 0 0 0 0", "world", "rocker"),
            ("c", "rocker", "0 0 0.3 0 0 0", "coupler", "rocker"),
        )
    )
    simulation = make_simulation(f'<model name="m">{bars}{joints}</model>')
    simulation.push("m::crank", (0.0, 0.0, 0.0), (0.0, 0.01, 0.0))
    for _ in range(20):
        simulation.advance(100 * MILLISECOND)
        # In a parallelogram, crank and rocker rotate by the same angle, and the coupler does not rotate.
        crank, rocker = (simulation.joint_state(f"m::{name}")[0] for name in ("a", "d"))
        assert crank == pytest.approx(rocker, abs=2e-3)
    assert abs(simulation.joint_state("m::a")[0]) > 0.1


def test_robot_at_rest_does_not_drift():
    simulation = make_simulation(GROUND, mbot())
    simulation.advance(NANOSECONDS_PER_SECOND)
    x, y, z, *_ = simulation.model_pose("mbot")
    simulation.advance(60 * NANOSECONDS_PER_SECOND)
    assert simulation.model_pose("mbot")[:3] == pytest.approx((x, y, z), abs=1e-4)


class Driver:
    """A driver that turns mbot's wheels 100 times a second, as a node would.

    The wheels accelerate with 1 m/s2 at the rims.
    """

    def __init__(self, forward: float, yaw_rate: float) -> None:
        self.simulation: Simulation = make_simulation(GROUND, mbot())
        self._motors: list[Motor] = [
            self.simulation.add_velocity_motor(f"mbot::{side}_joint", 20.0, 5.0) for side in ("left", "right")
        ]
        self._targets = [forward - yaw_rate * 0.19, forward + yaw_rate * 0.19]
        self._rims = [0.0, 0.0]
        self.ideal = [0.0, 0.0, 0.0]
        self.simulation.call_every(10 * MILLISECOND, self._update)

    def _update(self) -> None:
        v, w = sum(self._rims) / 2, (self._rims[1] - self._rims[0]) / 0.38
        x, y, heading = self.ideal
        self.ideal = [
            x + v * 0.01 * cos(heading + w * 0.005),
            y + v * 0.01 * sin(heading + w * 0.005),
            heading + w * 0.01,
        ]
        for index, target in enumerate(self._targets):
            self._rims[index] += max(-0.01, min(0.01, target - self._rims[index]))
            self._motors[index].target = self._rims[index] / 0.06

    def errors(self) -> tuple[float, float]:
        """Return the distance from the ideal position in m, and the heading error in rad."""
        x, y, _, *orientation = self.simulation.model_pose("mbot")
        heading = rpy_from_quaternion((orientation[0], orientation[1], orientation[2], orientation[3]))[2]
        return hypot(x - self.ideal[0], y - self.ideal[1]), (heading - self.ideal[2] + pi) % (2 * pi) - pi


@pytest.mark.parametrize(
    ("forward", "yaw_rate", "max_distance", "max_angle"),
    [(0.5, 0.0, 1e-3, 1e-3), (1.0, 1.0, 10e-3, 2e-3), (0.0, 1.0, 1e-3, 0.1 * pi / 180)],
    ids=["straight", "arc", "spin"],
)
def test_robot_motion_matches_wheel_rotation(forward, yaw_rate, max_distance, max_angle):
    driver = Driver(forward, yaw_rate)
    driver.simulation.advance(10 * NANOSECONDS_PER_SECOND + 500 * MILLISECOND)
    distance, angle = driver.errors()
    assert distance < max_distance
    assert abs(angle) < max_angle
