"""Small worlds for tests of the simulation, as text."""

from __future__ import annotations

from pathlib import Path

from linkwright.descriptions.service import examine_world
from linkwright.packages import PackageFinder
from linkwright.sdf.models import Model
from linkwright.sdf.reader import read
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.text import parse_as_gazebo
from linkwright.sdf.worlds import World
from linkwright.simulation.simulation import Simulation

GROUND = """
<model name="ground"><static>true</static><link name="link"><collision name="collision">
  <geometry><plane><normal>0 0 1</normal></plane></geometry>
</collision></link></model>"""

_DRUM = "<cylinder><radius>{radius}</radius><length>{length}</length></cylinder>"
_BALL = "<sphere><radius>{radius}</radius></sphere>"


def world(*parts: str, step: float = 0.001, gravity: str = "0 0 -9.81") -> World:
    """Return a world in SDF with these elements."""
    text = (
        f'<sdf version="1.7"><world name="test"><gravity>{gravity}</gravity>'
        f'<physics type="ode"><max_step_size>{step}</max_step_size></physics>{"".join(parts)}</world></sdf>'
    )
    return _read(text).worlds[0]


def model(text: str) -> Model:
    """Return the only model of a text."""
    return _read(f'<sdf version="1.7">{text}</sdf>').models[0]


def _read(text: str):
    document, warnings = parse_as_gazebo(text.encode(), "test.world")
    reading = read(document)
    assert not [*warnings, *reading.diagnostics]
    return reading.sdf


def finder(*folders: Path) -> ResourceFinder:
    """Return a finder that searches only these folders."""
    return ResourceFinder(PackageFinder(start=folders), {})


def make_simulation(*parts: str, step: float = 0.001, gravity: str = "0 0 -9.81") -> Simulation:
    """Return a simulation of a world with these elements."""
    return Simulation(world(*parts, step=step, gravity=gravity), finder())


def load_simulation(path: Path) -> Simulation:
    """Return a simulation of the world in a file."""
    description = examine_world(path)
    assert description.sdf is not None
    return Simulation(description.sdf.worlds[0], ResourceFinder(PackageFinder(start=[path.parent])))


def box(name: str, pose: str, size: str = "1 1 1", mass: float = 1.0, surface: str = "") -> str:
    """Return a movable box with the inertia of a solid box."""
    x, y, z = (float(length) for length in size.split())
    inertia = (
        f"<ixx>{mass * (y * y + z * z) / 12}</ixx><iyy>{mass * (x * x + z * z) / 12}</iyy>"
        f"<izz>{mass * (x * x + y * y) / 12}</izz>"
    )
    return (
        f'<model name="{name}"><pose>{pose}</pose><link name="link"><inertial><mass>{mass}</mass>'
        f'<inertia>{inertia}</inertia></inertial><collision name="collision"><geometry><box><size>{size}</size></box>'
        f"</geometry>{surface}</collision></link></model>"
    )


def mbot(pose: str = "0 0 0.11 0 0 0") -> str:
    """Return a robot with two wheels and two casters, as large as the tutorial's."""
    wheel = _part(_DRUM.format(radius=0.06, length=0.025), 0.2, (1.9e-4, 1.9e-4, 3.6e-4))
    caster = _part(_BALL.format(radius=0.015), 0.02, (2e-6, 2e-6, 2e-6), friction=0.0)
    base = _part(_DRUM.format(radius=0.2, length=0.16), 5.0, (0.0607, 0.0607, 0.1))
    return f"""
<model name="mbot"><pose>{pose}</pose>
  <link name="base_link">{base}</link>
  <link name="left_wheel"><pose>0 0.19 -0.05 1.570796326794897 0 0</pose>{wheel}</link>
  <link name="right_wheel"><pose>0 -0.19 -0.05 1.570796326794897 0 0</pose>{wheel}</link>
  <link name="front_caster"><pose>0.18 0 -0.095 0 0 0</pose>{caster}</link>
  <link name="back_caster"><pose>-0.18 0 -0.095 0 0 0</pose>{caster}</link>
  {_joint("left_joint", "left_wheel")}{_joint("right_joint", "right_wheel")}
  <joint name="front" type="ball"><parent>base_link</parent><child>front_caster</child></joint>
  <joint name="back" type="ball"><parent>base_link</parent><child>back_caster</child></joint>
</model>"""


def _joint(name: str, wheel: str) -> str:
    return (
        f'<joint name="{name}" type="continuous"><parent>base_link</parent><child>{wheel}</child>'
        '<axis><xyz expressed_in="__model__">0 1 0</xyz></axis></joint>'
    )


def _part(shape: str, mass: float, moments: tuple[float, float, float], friction: float = 1.0) -> str:
    ixx, iyy, izz = moments
    return (
        f"<inertial><mass>{mass}</mass><inertia><ixx>{ixx}</ixx><iyy>{iyy}</iyy><izz>{izz}</izz></inertia></inertial>"
        f'<collision name="collision"><geometry>{shape}</geometry><surface><friction><ode><mu>{friction}</mu>'
        f"<mu2>{friction}</mu2></ode></friction></surface></collision>"
    )
