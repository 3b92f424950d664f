"""A graph of planar poses, and its optimization."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from linkwright.navigation.grids.library import load_scipy
from linkwright.navigation.slam.poses import FloatArray, wrap_angles
from linkwright.navigation.slam.steps import Steps

_MAX_ITERATIONS = 20
_CONVERGENCE_STEP = 1e-5
_KERNEL_SCALE = 9.0
"""The scale of the Cauchy kernel, in squared standard deviations: doubtful edges with larger errors count less."""


@dataclass(slots=True)
class PoseGraph:
    """A graph of poses and measured relative poses between them.

    The first pose is fixed. The graph is solved by Gauss-Newton on sparse matrices (Grisetti et al., "A Tutorial on
    Graph-Based SLAM", 2010). Doubtful edges, such as those of loops, get a Cauchy kernel in a second pass.

    Attributes:
        poses: the poses of the nodes, of shape (n, 3).
        first: the first node of each edge.
        second: the second node of each edge.
        measured: for each edge, the pose of the second node in the frame of the first, of shape (3,).
        information: for each edge, the inverse of the covariance of `measured` in the frame of the second node, of
            shape (3, 3).
        is_doubtful: for each edge, whether it may be wrong.
    """

    poses: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    first: list[int] = field(default_factory=list)
    second: list[int] = field(default_factory=list)
    measured: list[FloatArray] = field(default_factory=list)
    information: list[FloatArray] = field(default_factory=list)
    is_doubtful: list[bool] = field(default_factory=list)

    def add_node(self, pose: FloatArray) -> int:
        """Add a node at a pose of shape (3,).

        Returns:
            The index of the node.
        """
        self.poses = np.concatenate((self.poses, pose[None]))
        return len(self.poses) - 1

    def add_edge(
        self, first: int, second: int, measured: FloatArray, information: FloatArray, *, is_doubtful: bool = False
    ) -> None:
        """Add a measured relative pose between two nodes.

        The arguments have the same names as the attributes of the class.
        """
        self.first.append(first)
        self.second.append(second)
        self.measured.append(measured)
        self.information.append(information)
        self.is_doubtful.append(is_doubtful)

    def solve(self) -> Steps[float]:
        """Optimize the poses with respect to all edges, in steps.

        Returns:
            The largest distance that a node moved, in meters.
        """
        old_poses = self.poses.copy()
        if self.first and len(self.poses) > 1:
            for robust in (False, True) if any(self.is_doubtful) else (False,):
                for _ in range(_MAX_ITERATIONS):
                    step = self._step(robust=robust)
                    yield
                    if step < _CONVERGENCE_STEP:
                        break
        return float(np.hypot(*(self.poses - old_poses)[:, :2].T).max(initial=0.0))

    def _step(self, *, robust: bool) -> float:
        residuals, first_jacobians, second_jacobians = self._linearize()
        information = np.array(self.information)
        if robust:
            errors = np.einsum("ni,nij,nj->n", residuals, information, residuals)
            weights = np.where(self.is_doubtful, 1 / (1 + errors / _KERNEL_SCALE), 1.0)
            information = information * weights[:, None, None]
        sparse, linalg = load_scipy("sparse"), load_scipy("sparse.linalg")
        size = 3 * len(self.poses)
        edges, components = np.arange(3 * len(self.first)), np.arange(3)
        rows = np.broadcast_to(edges.reshape(-1, 3, 1), (len(self.first), 3, 3)).ravel()

        def block(values: FloatArray, nodes: list[int]) -> Any:
            columns = np.broadcast_to((3 * np.array(nodes)[:, None] + components)[:, None, :], values.shape)
            return sparse.csr_matrix((values.ravel(), (rows, columns.ravel())), shape=(len(edges), size))

        jacobian = block(first_jacobians, self.first) + block(second_jacobians, self.second)
        columns = np.broadcast_to(edges.reshape(-1, 1, 3), information.shape).ravel()
        weight = sparse.csr_matrix((information.ravel(), (rows, columns)), shape=(len(edges), len(edges)))
        weighted = jacobian.T @ weight
        matrix = (weighted @ jacobian)[3:, 3:] + 1e-9 * sparse.identity(size - 3)
        step: FloatArray = np.asarray(linalg.spsolve(matrix.tocsc(), -(weighted @ residuals.ravel())[3:])).reshape(
            -1, 3
        )
        self.poses[1:] += step
        self.poses[:, 2] = wrap_angles(self.poses[:, 2])
        return float(np.abs(step).max())

    def _linearize(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the residuals of the edges, (m, 3), and their Jacobians, (m, 3, 3) each.

        The Jacobians are with respect to the first and the second pose of each edge.
        """
        start, end = self.poses[self.first], self.poses[self.second]
        measured = np.array(self.measured)
        yaw = start[:, 2] + measured[:, 2]
        cos, sin = np.cos(yaw), np.sin(yaw)
        to_second = np.stack((np.stack((cos, sin), -1), np.stack((-sin, cos), -1)), axis=1)  # Rotates world vectors.
        offsets = end[:, :2] - start[:, :2]
        residuals = np.zeros((len(start), 3))
        cos_m, sin_m = np.cos(measured[:, 2]), np.sin(measured[:, 2])
        x, y = measured[:, 0], measured[:, 1]
        residuals[:, :2] = np.einsum("nij,nj->ni", to_second, offsets)
        residuals[:, :2] -= np.stack((cos_m * x + sin_m * y, cos_m * y - sin_m * x), axis=-1)
        residuals[:, 2] = wrap_angles(end[:, 2] - yaw)
        second_jacobians = np.zeros((len(start), 3, 3))
        second_jacobians[:, :2, :2] = to_second
        second_jacobians[:, 2, 2] = 1.0
        first_jacobians = -second_jacobians
        rotated_offsets = np.stack(
            (offsets[:, 1], -offsets[:, 0]), axis=-1
        )  # The derivative of R(-yaw) v is R(-yaw) (v_y, -v_x).
        first_jacobians[:, :2, 2] = np.einsum("nij,nj->ni", to_second, rotated_offsets)
        return residuals, first_jacobians, second_jacobians
