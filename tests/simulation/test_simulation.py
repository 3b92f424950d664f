"""A moving world: time, models that are added and removed, and reproducibility."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.simulation import Simulation, UnstableError
from tests.simulation.worlds import GROUND, box, finder, make_simulation, mbot, model, world

MILLISECOND = NANOSECONDS_PER_SECOND // 1000


def test_body_falls_with_gravity():
    simulation = make_simulation(box("ball", "0 0 100 0 0 0"))
    simulation.advance(NANOSECONDS_PER_SECOND)
    # The semi-implicit integration lags by half a step: g t dt / 2.
    assert simulation.model_pose("ball")[2] == pytest.approx(100 - 9.81 / 2, abs=9.81 * 0.001 / 2 + 1e-9)
    assert simulation.link_velocity("ball::link")[0][2] == pytest.approx(-9.81, abs=1e-9)


def test_periodic_tasks_are_called_on_time_in_order():
    simulation = make_simulation(GROUND)
    calls: list[tuple[str, int]] = []
    simulation.call_every(3 * MILLISECOND, lambda: calls.append(("three", simulation.time // MILLISECOND)))
    simulation.call_every(2 * MILLISECOND, lambda: calls.append(("two", simulation.time // MILLISECOND)))
    simulation.advance(6 * MILLISECOND)
    assert calls == [("two", 2), ("three", 3), ("two", 4), ("three", 6), ("two", 6)]


def test_robot_drives_straight():
    simulation = make_simulation(GROUND, mbot())
    motors = [simulation.add_velocity_motor(f"mbot::{side}_joint", 20.0, 5.0) for side in ("left", "right")]
    start_angle = simulation.joint_state("mbot::left_joint")[0]
    for hundredth in range(1, 101):
        for motor in motors:
            motor.target = hundredth / 100 * 0.5 / 0.06
        simulation.advance(5 * MILLISECOND)
    simulation.advance(9 * NANOSECONDS_PER_SECOND)
    x, y, _z, *_ = simulation.model_pose("mbot")
    wheel_angle = simulation.joint_state("mbot::left_joint")[0] - start_angle
    assert x == pytest.approx(wheel_angle * 0.06, abs=1e-3)
    assert x > 4.5
    assert abs(y) < 1e-4


@pytest.mark.parametrize(
    ("shape", "radius"),
    [
        ("<sphere><radius>0.3</radius></sphere>", 0.3),
        ("<cylinder><radius>0.2</radius><length>0.1</length></cylinder>", 0.2),
        ("<box><size>1 1 1</size></box>", None),
    ],
)
def test_wheel_radius_of_round_shapes(shape, radius):
    collision = f"<collision name='c'><geometry>{shape}</geometry></collision>"
    simulation = make_simulation(f"<model name='a'><link name='link'>{collision}</link></model>")
    assert simulation.wheel_radius("a::link") == radius


def test_simulation_is_reproducible():
    def run() -> tuple[float, ...]:
        simulation = make_simulation(GROUND, mbot(), box("box", "0.5 0.05 0.2 0 0 0", "0.2 0.2 0.2"))
        motors = [simulation.add_velocity_motor(f"mbot::{side}_joint", 20.0, 5.0) for side in ("left", "right")]
        motors[0].target, motors[1].target = 5.0, 6.0
        simulation.advance(2 * NANOSECONDS_PER_SECOND)
        return simulation.model_pose("mbot") + simulation.model_pose("box")

    assert run() == run()


def test_spawn_and_delete_keep_other_models():
    simulation = make_simulation(GROUND, box("one", "0 0 5 0 0 0"))
    simulation.advance(100 * MILLISECOND)
    state = simulation.model_pose("one"), tuple(simulation.link_velocity("one::link")[0])
    simulation.spawn(model(box("two", "0 0 0 0 0 0")), "two", (3.0, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0))
    assert (simulation.model_pose("one"), tuple(simulation.link_velocity("one::link")[0])) == state
    assert simulation.model_pose("two")[:3] == (3.0, 0.0, 0.5)
    simulation.delete("one")
    assert simulation.model_pose("two")[:3] == (3.0, 0.0, 0.5)
    simulation.advance(100 * MILLISECOND)
    with pytest.raises(KeyError):
        simulation.model_pose("one")


def test_duplicate_model_name_is_rejected():
    simulation = make_simulation(box("one", "0 0 5 0 0 0"))
    with pytest.raises(LinkwrightError, match="a model 'one' already exists"):
        simulation.spawn(model(box("one", "0 0 0 0 0 0")), "one")


def test_reset_restores_start():
    simulation = make_simulation(GROUND, box("one", "0 0 5 0 0 0"))
    calls: list[int] = []
    simulation.call_every(10 * MILLISECOND, lambda: calls.append(simulation.time))
    simulation.advance(20 * MILLISECOND)
    simulation.reset()
    assert simulation.time == 0
    assert simulation.model_pose("one")[2] == 5.0
    simulation.advance(20 * MILLISECOND)
    assert calls == [10 * MILLISECOND, 20 * MILLISECOND] * 2


def test_instability_is_reported_with_link():
    simulation = make_simulation(box("one", "0 0 5 0 0 0"), box("two", "0 3 5 0 0 0"))
    simulation.advance(10 * MILLISECOND)
    simulation.push("two::link", (0.0, 1e300, 0.0))
    with pytest.raises(UnstableError, match="'two::link'"):
        simulation.advance(NANOSECONDS_PER_SECOND)
    assert all(isfinite(coordinate) for name in ("one", "two") for coordinate in simulation.model_pose(name))


def test_nan_force_is_reported_with_link():
    simulation = make_simulation(box("one", "0 0 5 0 0 0"), box("two", "0 3 5 0 0 0"))
    simulation.push("two::link", (0.0, float("nan"), 0.0))
    with pytest.raises(UnstableError, match="'two::link'"):
        simulation.advance(NANOSECONDS_PER_SECOND)


def test_duplicate_model_of_world_is_omitted():
    first, second = (world(box("one", f"0 0 {height} 0 0 0")) for height in (5, 9))
    simulation = Simulation(replace(first, models=first.models + second.models), finder())
    assert simulation.model_pose("one")[2] == 5.0


def test_too_many_links_are_rejected(monkeypatch):
    monkeypatch.setattr("linkwright.simulation.scene.compiling.MAX_LINKS", 3)
    with pytest.raises(LinkwrightError, match="the world has 4 links, more than can be simulated"):
        make_simulation(*(box(f"box{index}", f"{index} 0 5 0 0 0") for index in range(4)))
