"""Joint solving of many robots, in which bodies at rest still fall asleep."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.simulation import Simulation
from linkwright.simulation.solver_selection import SolverSelector
from tests.simulation.worlds import GROUND, box, make_simulation, mbot

ROBOT_COUNT = 9
CHECK_PERIOD = 20 * NANOSECONDS_PER_SECOND // 1000


def make_driving_robots(*extra_models: str, robots: int = ROBOT_COUNT) -> Simulation:
    """Return robots side by side that drive straight.

    Each is a little faster than the previous one.
    """
    robot_models = [
        mbot(f"0 {number} 0.11 0 0 0").replace('name="mbot"', f'name="mbot{number}"', 1) for number in range(robots)
    ]
    simulation = make_simulation(GROUND, *robot_models, *extra_models)
    motors = [
        [simulation.add_velocity_motor(f"mbot{number}::{side}_joint", 20.0, 5.0) for side in ("left", "right")]
        for number in range(robots)
    ]
    simulation.recompile_if_changed()
    for number, pair in enumerate(motors):
        for motor in pair:
            motor.target = 1.0 + number
    return simulation


def is_solved_jointly(simulation: Simulation) -> bool:
    """Return whether MuJoCo solves for all bodies together."""
    mujoco, option = load_mujoco(), simulation.model.opt
    islands = not option.disableflags & mujoco.mjtDisableBit.mjDSBL_ISLAND.value
    sleeps = bool(option.enableflags & mujoco.mjtEnableBit.mjENBL_SLEEP.value)
    assert islands is sleeps
    return not islands


def test_joint_solving_of_many_robots_gives_same_motion(monkeypatch):
    together = make_driving_robots()
    together.advance(5 * CHECK_PERIOD)
    assert is_solved_jointly(together)
    together.advance(NANOSECONDS_PER_SECOND)
    with monkeypatch.context() as patch:
        patch.setattr(SolverSelector, "_update_solver", lambda _: None)
        reference = make_driving_robots()
        reference.advance(5 * CHECK_PERIOD + NANOSECONDS_PER_SECOND)
        assert not is_solved_jointly(reference)
    assert together.model_pose("mbot8")[0] > 0.3
    np.testing.assert_allclose(together.data.qpos, reference.data.qpos, atol=1e-7)


def test_few_robots_are_solved_separately():
    simulation = make_driving_robots(robots=4)
    simulation.advance(5 * CHECK_PERIOD)
    assert not is_solved_jointly(simulation)


def test_resting_boxes_fall_asleep_while_robots_drive():
    boxes = [box(f"box{number}", f"{number} -3 0.1 0 0 0", "0.2 0.2 0.2") for number in range(6)]
    simulation = make_driving_robots(*boxes)
    simulation.advance(2 * CHECK_PERIOD)
    assert is_solved_jointly(simulation)  # the boxes are still moving
    simulation.advance(2 * NANOSECONDS_PER_SECOND)
    assert not is_solved_jointly(simulation)
    assert simulation.data.ntree_awake == ROBOT_COUNT
    simulation.push("box0::link", (0.0, 0.0, 20.0))
    simulation.advance(100 * NANOSECONDS_PER_SECOND // 1000)
    assert simulation.link_pose("box0::link")[2] > 0.11


def test_sleeping_box_wakes_when_hit_during_joint_solving():
    simulation = make_driving_robots(box("wall", "1.2 8 0.1 0 0 0", "0.2 0.4 0.2", mass=0.2))
    tree = int(simulation.model.body_treeid[simulation.model.body("wall::link").id])
    simulation.advance(51 * CHECK_PERIOD)
    assert not is_solved_jointly(simulation)  # the check has found the bodies at rest
    simulation.advance(CHECK_PERIOD * 3 // 4)
    assert simulation.data.tree_asleep[tree] >= 0
    simulation.advance(CHECK_PERIOD // 2)
    assert is_solved_jointly(simulation)
    assert simulation.link_pose("wall::link")[0] == pytest.approx(1.2, abs=1e-4)
    simulation.advance(2 * NANOSECONDS_PER_SECOND)
    wall_position = simulation.link_pose("wall::link")[0]
    assert wall_position > simulation.model_pose("mbot8")[0] > 1.2
    simulation.advance(NANOSECONDS_PER_SECOND)
    assert simulation.link_pose("wall::link")[0] > wall_position + 0.1


def test_reset_is_bitwise_reproducible():
    simulation = make_driving_robots()
    simulation.advance(NANOSECONDS_PER_SECOND // 2)
    first_positions = simulation.data.qpos.tobytes()
    simulation.reset()
    assert not is_solved_jointly(simulation)
    for number in range(ROBOT_COUNT):
        assert simulation.model_pose(f"mbot{number}")[0] == pytest.approx(0.0)
    simulation.data.ctrl[:] = np.repeat(1.0 + np.arange(ROBOT_COUNT), 2)
    simulation.advance(NANOSECONDS_PER_SECOND // 2)
    assert simulation.data.qpos.tobytes() == first_positions


def test_remaining_robots_are_solved_separately_after_delete():
    simulation = make_driving_robots()
    simulation.advance(5 * CHECK_PERIOD)
    assert is_solved_jointly(simulation)
    for number in range(4):
        simulation.delete(f"mbot{number}")
    simulation.advance(5 * CHECK_PERIOD)
    assert not is_solved_jointly(simulation)
    assert simulation.schedule.next_time is None
