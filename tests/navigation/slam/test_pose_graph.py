"""Pose graphs with known solutions."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from linkwright.navigation.grids.library import load_scipy
from linkwright.navigation.slam.pose_graph import PoseGraph
from linkwright.navigation.slam.poses import compose, relative_pose, wrap_angles
from linkwright.navigation.slam.steps import run_to_end


def make_square(noise=0.0, seed=0, side=10):
    """Return the true poses around a square, and a graph whose chain of edges drifts."""
    rng = np.random.default_rng(seed)
    steps = [(1.0, 0.0, 0.0)] * side + [(0.0, 0.0, np.pi / 2)]
    true_poses = [np.zeros(3)]
    for step in steps * 4:
        true_poses.append(compose(true_poses[-1], np.array(step)))
    graph = PoseGraph()
    graph.add_node(true_poses[0])
    for number, (old, new) in enumerate(pairwise(true_poses)):
        measurement = relative_pose(old, new) + rng.normal(0, noise, 3)
        graph.add_node(compose(graph.poses[number], measurement))
        graph.add_edge(number, number + 1, measurement, np.diag([1e2, 1e2, 1e3]))
    return np.array(true_poses), graph


def weighted_residuals(graph, poses):
    """The deviation of each edge, in standard deviations."""
    residual = relative_pose(np.array(graph.measured), relative_pose(poses[graph.first], poses[graph.second]))
    residual[:, 2] = wrap_angles(residual[:, 2])
    return residual * np.sqrt([np.diag(matrix) for matrix in graph.information])


def pose_errors(graph):
    return (weighted_residuals(graph, graph.poses) ** 2).sum(axis=1)


def test_chain_without_loop_is_unchanged():
    _, graph = make_square(noise=0.02)
    poses_before = graph.poses.copy()
    run_to_end(graph.solve())
    assert graph.poses == pytest.approx(poses_before, abs=1e-6)
    assert pose_errors(graph) == pytest.approx(np.zeros(len(poses_before) - 1), abs=1e-6)


def test_loop_error_is_distributed_by_information():
    """Three steps of 1 m have the information 1, 2 and 4, and a measured sum of 3.7 m.

    Each changes by its variance.
    """
    graph = PoseGraph()
    graph.add_node(np.zeros(3))
    for number, information in enumerate((1.0, 2.0, 4.0)):
        graph.add_node(np.array([number + 1.0, 0, 0]))
        graph.add_edge(number, number + 1, np.array([1.0, 0, 0]), information * np.eye(3))
    graph.add_edge(0, 3, np.array([3.7, 0, 0]), 1.0 * np.eye(3))
    run_to_end(graph.solve())
    variances = np.array([1, 1 / 2, 1 / 4, 1])
    shares = 0.7 * variances / variances.sum()
    assert np.diff(graph.poses[:, 0]) == pytest.approx(1 + shares[:3], abs=1e-6)
    assert graph.poses[:, 1:] == pytest.approx(np.zeros((4, 2)), abs=1e-6)


def test_closed_loop_matches_batch_least_squares():
    _, graph = make_square(noise=0.03, seed=4, side=3)
    last = len(graph.poses) - 1
    graph.add_edge(0, last, np.zeros(3), np.diag([1e4, 1e4, 1e4]))
    start = graph.poses.copy()
    run_to_end(graph.solve())

    def residuals(is_planar):
        poses = np.concatenate((start[:1], is_planar.reshape(-1, 3)))
        return weighted_residuals(graph, poses).ravel()

    batch = load_scipy("optimize").least_squares(residuals, start[1:].ravel(), xtol=1e-14, ftol=1e-14, gtol=1e-14)
    assert (pose_errors(graph).sum()) == pytest.approx(2 * batch.cost, rel=1e-6)
    deviation = relative_pose(batch.x.reshape(-1, 3), graph.poses[1:])
    assert deviation == pytest.approx(np.zeros(deviation.shape), abs=1e-4)


def test_loop_closure_corrects_drifting_square():
    true_poses, graph = make_square(noise=0.01, seed=2)
    last = len(true_poses) - 1
    error_before = np.hypot(*(graph.poses - true_poses)[:, :2].T).max()
    graph.add_edge(0, last, np.zeros(3), np.eye(3) * 1e6)
    run_to_end(graph.solve())
    error_after = np.hypot(*(graph.poses - true_poses)[:, :2].T).max()
    assert graph.poses[last] == pytest.approx(true_poses[0], abs=1e-3)
    assert error_after < error_before / 2


def test_wrong_edge_among_right_ones_is_rejected():
    true_poses, graph = make_square(noise=0.005, seed=3)
    last = len(true_poses) - 1
    for first, second in ((0, last), (1, last - 1), (3, last), (0, 41), (2, last)):
        measurement = relative_pose(true_poses[first], true_poses[second])
        graph.add_edge(first, second, measurement, np.eye(3) * 1e4, is_doubtful=True)
    graph.add_edge(5, 25, np.array([1.0, 1.0, 0.0]), np.eye(3) * 1e4, is_doubtful=True)
    run_to_end(graph.solve())
    assert np.hypot(*(graph.poses - true_poses)[:, :2].T).max() < 0.2
    assert pose_errors(graph)[-1] > 1e4
