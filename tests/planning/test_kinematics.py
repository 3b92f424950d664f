"""Link frames by MuJoCo, and inverse kinematics."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from linkwright.geometry.arrays import matrix_from_pose
from linkwright.kinematics import KinematicTree
from linkwright.planning.cartesian import ArcError, ArcPoint, arc_poses, follow_poses, line_poses
from linkwright.planning.inverse_kinematics import ChainSolver
from linkwright.planning.robot_model import PlacedShape, RobotModel
from tests.planning.arms import arm

pytestmark = pytest.mark.extra("arm")

IDENTITY = np.array((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))


def random_positions(count: int, seed: int = 1) -> list[np.ndarray]:
    """Return random positions of all joints of the arm."""
    random = np.random.default_rng(seed)
    samples = []
    for _ in range(count):
        positions = arm().positions(left=0.01)
        positions[arm().indexes] = arm().group.sample(random)
        samples.append(positions)
    return samples


class TestRobotModel:
    def test_frames_equal_those_of_kinematic_tree(self) -> None:
        tree = KinematicTree(arm().robot)
        assert tree.joint_names == arm().model.joint_names
        for positions in random_positions(20):
            frames = tree.forward(positions)
            arm().model.move(positions)
            for link in tree.link_names:
                np.testing.assert_allclose(
                    matrix_from_pose(arm().model.link_pose(link)), frames[tree.link_index(link)], atol=1e-9
                )

    def test_mimic_joint_follows(self) -> None:
        arm().model.move(arm().positions(left=0.02))
        names, positions = arm().model.all_positions()
        assert dict(zip(names, positions, strict=True))["right"] == 0.02

    def test_equal_hulls_share_a_mesh(self) -> None:
        corners = np.array(list(product((-0.1, 0.1), repeat=3)))
        shapes = {
            "upper_arm": [PlacedShape(corners, IDENTITY)],
            "tool": [PlacedShape(corners.copy(), IDENTITY), PlacedShape(2.0 * corners, IDENTITY)],
        }
        model = RobotModel(arm().robot, shapes).mujoco_model
        assert (model.ngeom, model.nmesh) == (3, 2)


class TestChainSolver:
    def test_reachable_poses_are_reached(self) -> None:
        solver = ChainSolver(arm().model, arm().group, "tool")
        solved = 0
        for positions, start in zip(random_positions(200), random_positions(200, seed=2), strict=True):
            arm().model.move(positions)
            target = arm().model.link_pose("tool")
            solution = solver.solve(target, start, 1.0)
            if solution is None:
                continue
            solved += 1
            assert arm().group.satisfies_bounds(solution[arm().indexes])
            arm().model.move(solution)
            reached = arm().model.link_pose("tool")
            np.testing.assert_allclose(reached[:3], target[:3], atol=2e-5)
            assert abs(float(reached[3:] @ target[3:])) > 1.0 - 1e-8
        assert solved >= 196

    def test_start_at_the_target_is_kept(self) -> None:
        start = arm().positions(lift=0.5, elbow=1.0, bend=0.4)
        arm().model.move(start)
        solver = ChainSolver(arm().model, arm().group, "tool")
        np.testing.assert_allclose(solver.solve(arm().model.link_pose("tool"), start, 0.1), start, atol=1e-4)

    def test_pose_out_of_reach_has_no_solution(self) -> None:
        solver = ChainSolver(arm().model, arm().group, "tool")
        target = np.array((3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
        assert solver.solve(target, arm().positions(), 0.05) is None

    def test_busy_computer_does_not_end_the_search_at_its_first_attempts(self) -> None:
        solver, solved = ChainSolver(arm().model, arm().group, "tool"), 0
        for positions, start in zip(random_positions(100), random_positions(100, seed=2), strict=True):
            arm().model.move(positions)
            solved += solver.solve(arm().model.link_pose("tool"), start, 0.0) is not None
        assert solved >= 98

    def test_poses_with_a_stretched_wrist_are_reached_without_a_restart(self) -> None:
        solver, random, reached = ChainSolver(arm().model, arm().group, "tool"), np.random.default_rng(3), 0
        for positions in random_positions(100):
            positions[arm().model.index("bend")] = 1e-3
            arm().model.move(positions)
            target, start = arm().model.link_pose("tool"), positions.copy()
            start[arm().indexes] += random.normal(0.0, 0.03, len(arm().indexes))
            reached += solver.solve_from(target, start) is not None
        assert reached >= 95

    def test_refused_solution_leads_to_another_one(self) -> None:
        start = arm().positions(lift=0.5, elbow=1.0, bend=0.4)
        arm().model.move(start)
        solver = ChainSolver(arm().model, arm().group, "tool")
        elbow = arm().model.index("elbow")
        solution = solver.solve(arm().model.link_pose("tool"), start, 2.0, lambda positions: positions[elbow] < 0.0)
        assert solution is not None
        assert solution[elbow] == pytest.approx(-1.0, abs=1e-3)


class TestLines:
    def test_tool_moves_on_a_straight_line(self) -> None:
        start = arm().positions(lift=0.6, elbow=1.2, bend=1.0)
        arm().model.move(start)
        first = arm().model.link_pose("tool")
        last = first + np.array((0.0, 0.15, 0.05, 0.0, 0.0, 0.0, 0.0))
        poses = line_poses(first, last, 0.01)
        assert len(poses) == 16
        solver = ChainSolver(arm().model, arm().group, "tool")
        path, fraction = follow_poses(solver, start, poses, arm().indexes)
        assert fraction == 1.0
        for positions in path:
            arm().model.move(positions)
            offset = arm().model.link_pose("tool")[:3] - first[:3]
            direction = (last - first)[:3] / np.linalg.norm((last - first)[:3])
            assert np.linalg.norm(offset - offset @ direction * direction) < 1e-4

    def test_rest_of_a_line_that_leaves_the_reach_is_left_out(self) -> None:
        start = arm().positions(lift=0.6, elbow=1.2, bend=1.0)
        arm().model.move(start)
        first = arm().model.link_pose("tool")
        poses = line_poses(first, first + np.array((2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)), 0.02)
        path, fraction = follow_poses(ChainSolver(arm().model, arm().group, "tool"), start, poses, arm().indexes)
        assert 0.0 < fraction < 0.5
        assert len(path) == 1 + round(fraction * len(poses))


class TestArcs:
    START, END = np.array((1.0, 0, 0, 0, 0, 0, 1)), np.array((0, 1.0, 0, 0, 0, np.sin(0.5), np.cos(0.5)))

    @pytest.mark.parametrize(
        ("point", "is_center", "angle"),
        [
            ((0.0, 0.0, 0.0), True, 0.5 * np.pi),
            ((np.sqrt(0.5), np.sqrt(0.5), 0.0), False, 0.5 * np.pi),
            ((-1.0, 0.0, 0.0), False, 1.5 * np.pi),
        ],
    )
    def test_arc_has_the_radius_and_the_length(
        self, point: tuple[float, float, float], is_center: bool, angle: float
    ) -> None:
        poses = arc_poses(self.START, self.END, ArcPoint(np.array(point), is_center), 0.01)
        np.testing.assert_allclose(np.linalg.norm(poses[:, :3], axis=1), 1.0, atol=1e-9)
        np.testing.assert_allclose(poses[-1], self.END, atol=1e-9)
        steps = np.linalg.norm(np.diff(poses[:, :3], axis=0, prepend=self.START[None, :3]), axis=1)
        assert steps.max() <= 0.01
        assert steps.sum() == pytest.approx(angle, rel=1e-3)

    @pytest.mark.parametrize(
        ("point", "is_center", "reason"),
        [((0.5, 0.5, 0.0), False, "on a line"), ((0.0, 0.2, 0.0), True, "different")],
    )
    def test_impossible_arcs(self, point: tuple[float, float, float], is_center: bool, reason: str) -> None:
        with pytest.raises(ArcError, match=reason):
            arc_poses(self.START, self.END, ArcPoint(np.array(point), is_center), 0.01)
