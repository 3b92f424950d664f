"""The recorded paths of robots in stepped simulations."""

from __future__ import annotations

import pytest

from linkwright.testing import SteppedSimulation
from linkwright.testing.paths import MAX_POINTS, RobotPath, record_paths, start_path
from tests.places import PACKAGE

MBOT = PACKAGE / "urdf" / "mbot_gazebo.xacro"


def test_path_has_true_positions_in_each_period():
    with record_paths() as paths, SteppedSimulation("empty", MBOT, pose=(1, 2, 0, 0, 0, 0)) as simulation:
        simulation.drive(0.5)
        for _ in range(10):
            simulation.advance(0.1)
        x, y = simulation.robot_pose()[:2]
    (path,) = paths
    assert [point[0] for point in path.points] == pytest.approx([0.05 * index for index in range(21)])
    assert path.points[0][1:] == pytest.approx((1.0, 2.0), abs=1e-3)
    assert path.points[-1][1:] == (x, y)
    assert x > 1.2


def test_recording_changes_no_result():
    def drive() -> tuple[float, ...]:
        with SteppedSimulation("empty", MBOT) as simulation:
            simulation.drive(0.5, 0.3)
            simulation.advance(0.7)
            return simulation.robot_pose()

    unrecorded_pose = drive()
    with record_paths() as paths:
        assert drive() == unrecorded_pose
    assert len(paths) == 1


def test_reset_starts_a_new_path():
    with record_paths() as paths, SteppedSimulation("empty", MBOT) as simulation:
        simulation.drive(1.0)
        simulation.advance(0.5)
        simulation.reset()
        simulation.advance(0.2)
    assert [len(path.points) for path in paths] == [11, 5]
    assert paths[1].points[0] == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)


def test_path_ends_when_the_robot_is_deleted():
    with record_paths() as paths, SteppedSimulation("empty", MBOT) as simulation:
        simulation.advance(0.2)
        simulation.delete("mbot")
        simulation.advance(0.2)
    assert [len(path.points) for path in paths] == [5]


def test_simulation_without_a_robot_has_no_path():
    with record_paths() as paths, SteppedSimulation("empty") as simulation:
        simulation.advance(0.2)
    assert paths == []
    assert start_path() is None


def test_long_path_has_a_bounded_number_of_points():
    path = RobotPath()
    for number in range(10 * MAX_POINTS):
        time_ns = number * 50_000_000
        if path.is_due(time_ns):
            path.add(time_ns, float(number), 0.0)
    assert MAX_POINTS / 2 <= len(path.points) <= MAX_POINTS + 1
    steps = {round(after[1] - before[1]) for before, after in zip(path.points, path.points[1:], strict=False)}
    assert steps == {16}
