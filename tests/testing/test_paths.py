"""The recorded paths of robots in stepped simulations."""

from __future__ import annotations

import pytest

from linkwright.testing import SteppedSimulation
from linkwright.testing.paths import MAX_POINTS, RobotPath, new_path, recorded_paths
from tests.places import PACKAGE

MBOT = PACKAGE / "urdf" / "mbot_gazebo.xacro"


def test_path_has_true_positions_in_each_period():
    with recorded_paths() as paths, SteppedSimulation("empty", MBOT, pose=(1, 2, 0, 0, 0, 0)) as test:
        test.drive(0.5)
        for _ in range(10):
            test.advance(0.1)
        x, y = test.robot_pose()[:2]
    (path,) = paths
    assert [point[0] for point in path.points] == pytest.approx([0.05 * index for index in range(21)])
    assert path.points[0][1:] == pytest.approx((1.0, 2.0), abs=1e-3)
    assert path.points[-1][1:] == (x, y)
    assert x > 1.2


def test_recording_changes_no_result():
    def drive() -> tuple[float, ...]:
        with SteppedSimulation("empty", MBOT) as test:
            test.drive(0.5, 0.3)
            test.advance(0.7)
            return test.robot_pose()

    alone = drive()
    with recorded_paths() as paths:
        assert drive() == alone
    assert len(paths) == 1


def test_reset_starts_a_new_path():
    with recorded_paths() as paths, SteppedSimulation("empty", MBOT) as test:
        test.drive(1.0)
        test.advance(0.5)
        test.reset()
        test.advance(0.2)
    assert [len(path.points) for path in paths] == [11, 5]
    assert paths[1].points[0] == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)


def test_path_ends_when_the_robot_is_deleted():
    with recorded_paths() as paths, SteppedSimulation("empty", MBOT) as test:
        test.advance(0.2)
        test.delete("mbot")
        test.advance(0.2)
    assert [len(path.points) for path in paths] == [5]


def test_simulation_without_a_robot_has_no_path():
    with recorded_paths() as paths, SteppedSimulation("empty") as test:
        test.advance(0.2)
    assert paths == []
    assert new_path() is None


def test_long_path_has_a_bounded_number_of_points():
    path = RobotPath()
    for number in range(10 * MAX_POINTS):
        time_ns = number * 50_000_000
        if path.is_due(time_ns):
            path.add(time_ns, float(number), 0.0)
    assert MAX_POINTS / 2 <= len(path.points) <= MAX_POINTS + 1
    steps = {round(after[1] - before[1]) for before, after in zip(path.points, path.points[1:], strict=False)}
    assert steps == {16}
