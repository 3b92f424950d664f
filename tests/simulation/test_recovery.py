"""Bodies that start inside other bodies: they separate slowly, and are reported."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.server.overlaps import find_overlaps
from linkwright.simulation.simulation import Simulation
from tests.simulation.test_plugins import running_server
from tests.simulation.worlds import GROUND, box, make_simulation, model

SHAPES = {
    "box": "<box><size>1 1 1</size></box>",
    "ball": "<sphere><radius>0.5</radius></sphere>",
    "cylinder": "<cylinder><radius>0.3</radius><length>1</length></cylinder>",
    "capsule": "<capsule><radius>0.2</radius><length>0.6</length></capsule>",
    "ellipsoid": "<ellipsoid><radii>0.3 0.4 0.5</radii></ellipsoid>",
}
SEPARATION_SPEED_LIMIT = 0.4
"""A little more than the speed in m/s at which bodies separate."""
UPRIGHT = (
    '<model name="arm"><link name="base"/>'
    '<joint name="post" type="fixed"><parent>world</parent><child>base</child></joint>'
)


def free_body_model(name: str, shape: str, pose: str) -> str:
    return (
        f'<model name="{name}"><pose>{pose}</pose><link name="link"><inertial><mass>2</mass><inertia><ixx>0.2</ixx>'
        f"<iyy>0.2</iyy><izz>0.2</izz></inertia></inertial><collision name='c'><geometry>{SHAPES[shape]}</geometry>"
        "</collision></link></model>"
    )


def max_speed(simulation: Simulation, seconds: float, *links: str) -> float:
    """Return the maximum speed of some links in m/s."""
    highest = 0.0
    for _ in range(round(seconds * 100)):
        simulation.advance(NANOSECONDS_PER_SECOND // 100)
        highest = max(highest, *(float(np.linalg.norm(simulation.link_velocity(link)[0])) for link in links))
    return highest


@pytest.mark.parametrize("step", [0.001, 0.01])
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("depth", [0.2, 0.6])
def test_body_starting_inside_ground_rises_slowly_onto_it(shape: str, depth: float, step: float):
    simulation = make_simulation(GROUND, free_body_model("thing", shape, f"0 0 {0.5 - depth} 0 0 0"), step=step)
    assert max_speed(simulation, 3.5, "thing::link") < SEPARATION_SPEED_LIMIT
    assert simulation.link_pose("thing::link")[2] == pytest.approx(0.5, abs=0.01)


@pytest.mark.parametrize("shape", SHAPES)
def test_overlapping_bodies_separate_slowly(shape: str):
    simulation = make_simulation(
        free_body_model("one", shape, "0 0 5 0 0 0"),
        free_body_model("other", shape, "0.1 0.05 5 0 0 0"),
        gravity="0 0 0",
    )
    assert max_speed(simulation, 4.0, "one::link", "other::link") < SEPARATION_SPEED_LIMIT
    assert not find_overlaps(simulation)


def test_body_moved_into_wall_leaves_it_slowly():
    wall = box("wall", "3 0 1 0 0 0", "1 4 2").replace("<link", "<static>true</static><link", 1)
    simulation = make_simulation(GROUND, wall, free_body_model("crate", "box", "0 0 0.5 0 0 0"))
    simulation.advance(2 * NANOSECONDS_PER_SECOND)
    simulation.set_model_pose("crate", (2.6, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0))
    assert max_speed(simulation, 3.0, "crate::link") < SEPARATION_SPEED_LIMIT
    assert simulation.link_pose("crate::link")[0] == pytest.approx(2.0, abs=0.05)


def hinged_link(limits: str, extra: str = "") -> str:
    """Return a link that turns about a vertical axis."""
    inertia = "<inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>"
    return (
        f'{UPRIGHT}<link name="first">{inertia}</link><joint name="turn" type="revolute"><parent>base</parent>'
        f"<child>first</child><axis><xyz>0 0 1</xyz>{limits}</axis></joint>{extra}</model>"
    )


def test_joint_beyond_its_limit_returns_slowly():
    simulation = make_simulation(
        hinged_link("<limit><lower>1.2</lower><upper>2</upper></limit><dynamics><damping>0.5</damping></dynamics>")
    )
    speeds = []
    for _ in range(200):
        simulation.advance(NANOSECONDS_PER_SECOND // 100)
        speeds.append(simulation.joint_state("arm::turn")[1])
    assert 0.9 < max(speeds) < 1.05
    assert simulation.joint_state("arm::turn")[0] == pytest.approx(1.2, abs=0.01)


def test_servo_keeps_speed_while_other_bodies_separate():
    simulation = make_simulation(
        GROUND,
        free_body_model("deep", "box", "9 0 -0.4 0 0 0"),
        hinged_link("<limit><lower>-9</lower><upper>9</upper></limit>"),
    )
    servo = simulation.add_servo("arm::turn", speed=3.0)
    for _ in range(30):
        servo.move(2.0, 0.01)
        simulation.advance(NANOSECONDS_PER_SECOND // 100)
    assert simulation.joint_state("arm::turn")[0] == pytest.approx(0.9, abs=0.2)


def test_recovery_is_bitwise_reproducible():
    simulation = make_simulation(
        GROUND,
        *[free_body_model(f"t{number}", shape, f"0.{number} 0 0 0.2 0 0") for number, shape in enumerate(SHAPES)],
    )
    simulation.advance(NANOSECONDS_PER_SECOND)
    first_run = simulation.data.qpos.tobytes()
    simulation.reset()
    simulation.advance(NANOSECONDS_PER_SECOND)
    assert simulation.data.qpos.tobytes() == first_run


def test_recovery_ends_when_no_body_overlaps():
    simulation = make_simulation(GROUND, free_body_model("thing", "box", "0 0 0.3 0 0 0"))
    assert simulation._stepper._recovery.is_expected
    simulation.advance(2 * NANOSECONDS_PER_SECOND)
    assert not simulation._stepper._recovery.is_expected


def test_overlapping_models_are_reported_deepest_first():
    simulation = make_simulation(
        GROUND,
        free_body_model("low", "box", "0 0 0.2 0 0 0"),
        free_body_model("lower", "box", "5 0 0.1 0 0 0"),
        free_body_model("beside", "ball", "5.9 0 0.5 0 0 0"),
        free_body_model("fine", "box", "9 0 0.495 0 0 0"),
    )
    texts = [str(overlap.message) for overlap in find_overlaps(simulation)]
    assert texts == [
        "'lower' starts 0.40 m inside 'ground'",
        "'low' starts 0.30 m inside 'ground'",
        "'beside' starts 0.10 m inside 'lower'",
    ]
    assert [str(overlap.message) for overlap in find_overlaps(simulation, {"beside"})] == texts[2:]


def test_excess_overlaps_are_counted():
    simulation = make_simulation(
        GROUND, *[free_body_model(f"b{index}", "box", f"{2 * index} 0 0.2 0 0 0") for index in range(11)]
    )
    result = find_overlaps(simulation)
    assert len(result) == 9
    assert str(result[-1].message) == "3 other pairs of models overlap"


async def test_overlaps_are_logged_at_start_and_on_spawn():
    async with running_server(GROUND, free_body_model("low", "box", "0 0 0.2 0 0 0")) as (server, _, log):
        assert any("'low' starts 0.30 m inside 'ground'" in line.text for line in log)
        server.spawn(model(free_body_model("new", "ball", "0 0 0 0 0 0")), "new", (0.0, 0.0, 0.6, 0.0, 0.0, 0.0, 1.0))
        assert any("'new' starts 0.60 m inside 'low'" in line.text for line in log)
