"""Two ways to compute link frames: one configuration in few steps, many in few passes over memory.

For one configuration overhead dominates, so the number of array operations counts: frames are composed along paths that
double in length with each step. For many, memory counts: the last axis is that of the configurations, the tree is
computed level by level for a block of them that fits in the cache, and results are written once.
"""

from __future__ import annotations

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.kinematics.layout import Indices, Layout

_BLOCK = 384


class OneConfiguration:
    """Link frames for one configuration."""

    def __init__(self, layout: Layout) -> None:
        count = len(layout.parents)
        mounts = layout.mounts[1:]
        # A body in its parent is 1 * A + cos(q) * B + sin(q) * C + q * D, entry by entry.
        terms = np.zeros((count - 1, 4, 4, 4))
        turns, slides = ~layout.slides[1:], layout.slides[1:]
        terms[turns, 0, :, 2:] = mounts[turns, :, 2:]
        terms[turns, 1, :, :2] = mounts[turns, :, :2]
        terms[turns, 2, :, 0] = mounts[turns, :, 1]
        terms[turns, 2, :, 1] = -mounts[turns, :, 0]
        terms[slides, 0] = mounts[slides]
        terms[slides, 3, :, 3] = mounts[slides, :, 2]
        self._terms = terms.reshape(count - 1, 4, 16)
        self._jumps = _doubling_jumps(layout.parents, layout.depths)
        self._link_bodies = layout.link_bodies
        self._offsets = layout.offsets

    def frames(self, positions: Array) -> Array:
        """Link frames in the root; positions of shape (bodies - 1,) to (links, 4, 4)."""
        count = len(positions)
        factors = np.empty((4, count))
        factors[0] = 1.0
        np.cos(positions, factors[1])
        np.sin(positions, factors[2])
        factors[3] = positions
        bodies = np.empty((count + 1, 4, 4))
        bodies[0] = _IDENTITY
        np.matmul(factors.T[:, None, :], self._terms, bodies[1:].reshape(count, 1, 16))
        for first, above in self._jumps:
            deep = bodies[first:]
            deep[...] = bodies.take(above, 0) @ deep
        frames: Array = bodies.take(self._link_bodies, 0) @ self._offsets
        return frames


class ManyConfigurations:
    """Link frames for many configurations."""

    def __init__(self, layout: Layout) -> None:
        self._levels = [_Level(layout, depth) for depth in range(1, int(layout.depths.max()) + 1)]
        self._bodies = len(layout.parents)
        self._link_bodies = layout.link_bodies
        self._offsets_transposed = np.ascontiguousarray(layout.offsets.transpose(0, 2, 1))

    def frames(self, positions: Array) -> Array:
        """Link frames in the root; positions of shape (n, bodies - 1) to (n, links, 4, 4)."""
        count, links = len(positions), len(self._link_bodies)
        frames = np.empty((count, links, 4, 4))
        frames[:, :, 3] = _IDENTITY[3]
        for start in range(0, count, _BLOCK):
            block = positions[start : start + _BLOCK]
            size = len(block)
            # Axes: body, column, row, configuration; the last row of a matrix is not carried along.
            bodies = np.empty((self._bodies, 4, 3, size))
            bodies[0] = _IDENTITY.T[:, :3, None]
            by_joint = np.ascontiguousarray(block.T)
            cosines, sines = np.cos(by_joint), np.sin(by_joint)
            for level in self._levels:
                level.compute(bodies, by_joint, cosines, sines)
            columns = bodies.reshape(self._bodies, 4, 3 * size).take(self._link_bodies, 0)
            columns = self._offsets_transposed @ columns
            frames[start : start + size, :, :3] = columns.reshape(links, 4, 3, size).transpose(3, 0, 2, 1)
        return frames


class _Level:
    """The bodies with the same number of moving joints above them, those that turn before those that slide."""

    def __init__(self, layout: Layout, depth: int) -> None:
        members = np.flatnonzero(layout.depths == depth)
        self._turning = members[~layout.slides[members]]
        self._sliding = members[layout.slides[members]]
        members = np.concatenate((self._turning, self._sliding))
        self._members = members
        self._parents = layout.parents[members]
        self._mounts_transposed = np.ascontiguousarray(layout.mounts[members].transpose(0, 2, 1))

    def compute(self, bodies: Array, positions: Array, cosines: Array, sines: Array) -> None:
        count, size = len(self._members), bodies.shape[-1]
        parents = bodies.take(self._parents, 0).reshape(count, 4, 3 * size)
        mounted = (self._mounts_transposed @ parents).reshape(count, 4, 3, size)
        turning = len(self._turning)
        if turning:
            joints = self._turning - 1
            cosine, sine = cosines[joints, None], sines[joints, None]
            x, y = mounted[:turning, 0], mounted[:turning, 1]
            turned = x * cosine + y * sine
            y *= cosine
            y -= x * sine
            mounted[:turning, 0] = turned
        if turning < count:
            joints = self._sliding - 1
            mounted[turning:, 3] += mounted[turning:, 2] * positions[joints, None]
        bodies[self._members] = mounted


def _doubling_jumps(parents: Indices, depths: Indices) -> list[tuple[int, Indices]]:
    """For each step the first body that is deep enough to matter, and of it and all after it the ancestors.

    They are 1, 2, 4, ... bodies up, short of the root's body, whose frame changes nothing.
    """
    jumps = []
    jump = parents
    reach = 1
    while reach < depths[-1]:
        first = int(np.searchsorted(depths, reach, side="right"))
        jumps.append((first, jump[first:]))
        jump = jump[jump]
        reach *= 2
    return jumps


_IDENTITY: Array = np.eye(4)
