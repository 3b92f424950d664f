"""The shape of a set of frames, and how to compose poses along it for all frames together.

A robot may be one chain of hundreds of links, so going down level by level would mean hundreds of small steps. Instead
each round composes every frame with the frame that its pose is given in so far, which doubles the stretch it covers:
a chain of 500 takes nine rounds, a usual robot three or four.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.kinematics import IDENTITY, compose

Rows = NDArray[np.intp]
Poses = NDArray[np.float64]


class FrameTree:
    """Who is whose parent among n frames, worked up for `poses_in_roots`.

    Args:
        parents: array, shape (n,), of each frame's parent; -1 for frames without one.

    Attributes:
        roots: array, shape (n,), of the frame at the top of each one's tree; -1 where parents go round in a loop.
    """

    def __init__(self, parents: Rows) -> None:
        count = len(parents)
        every = np.arange(count, dtype=np.intp)
        rounds_enough = max(1, count).bit_length()
        above = np.where(parents >= 0, parents, every)
        for _ in range(rounds_enough):
            above = above[above]
        ends = parents[above] < 0 if count else np.zeros(0, dtype=np.bool_)
        self.roots: Rows = np.where(ends, above, -1)
        self._is_root = parents < 0
        self._rounds: list[tuple[Rows, Rows]] = []
        # A frame whose parent is a root has its final pose from the start.
        reference = np.where(ends & ~self._is_root & ~self._is_root[parents], parents, -1)
        while (active := np.flatnonzero(reference >= 0)).size:
            self._rounds.append((active, reference[active]))
            reference[active] = reference[reference[active]]

    def poses_in_roots(self, local: Poses) -> Poses:
        """Poses of all frames in the roots of their trees, shape (n, 7), from their poses in their parents.

        The rows of roots are the identity; those of frames in a loop mean nothing.
        """
        poses: Poses = local.copy()
        poses[self._is_root] = IDENTITY
        for active, reference in self._rounds:
            poses[active] = compose(poses.take(reference, axis=0), poses.take(active, axis=0))
        return poses
