"""A tf buffer without history, which stores only the latest transform of each frame.

A robot may be a chain of hundreds of links, so composing poses level by level would take hundreds of small steps.
Instead, each round composes the pose of every frame with the pose of its current reference frame. This doubles the
number of levels covered: a chain of 500 links takes nine rounds, a typical robot three or four.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import IDENTITY, compose, invert
from linkwright.graph.transforms.errors import (
    frame_loop_error,
    frame_name_error,
    not_connected_error,
    unknown_frame_error,
)
from linkwright.messages import TFMessage, TransformBatch

Rows = NDArray[np.intp]
Poses = NDArray[np.float64]


class FrameTree:
    """The tree of n frames, prepared so that `compute_root_poses` needs few array operations.

    Args:
        parents: array, shape (n,), of the index of each frame's parent; -1 for frames without a parent.

    Attributes:
        roots: array, shape (n,), of the index of the root of each frame's tree; -1 for frames whose parents form a
            loop.
    """

    def __init__(self, parents: Rows) -> None:
        count = len(parents)
        own_indices = np.arange(count, dtype=np.intp)
        round_count = max(1, count).bit_length()
        ancestors = np.where(parents >= 0, parents, own_indices)
        for _ in range(round_count):
            ancestors = ancestors[ancestors]
        reaches_root = parents[ancestors] < 0 if count else np.zeros(0, dtype=np.bool_)
        self.roots: Rows = np.where(reaches_root, ancestors, -1)
        self._is_root = parents < 0
        self._rounds: list[tuple[Rows, Rows]] = []
        # If a frame's parent is a root, the frame's pose is final from the start.
        reference = np.where(reaches_root & ~self._is_root & ~self._is_root[parents], parents, -1)
        while (active := np.flatnonzero(reference >= 0)).size:
            self._rounds.append((active, reference[active]))
            reference[active] = reference[reference[active]]

    def compute_root_poses(self, local: Poses) -> Poses:
        """Return the pose of each frame in the root of its tree, shape (n, 7).

        The rows of roots are the identity. The rows of frames in a loop are meaningless.

        Args:
            local: array, shape (n, 7), of the pose of each frame in its parent.
        """
        poses: Poses = local.copy()
        poses[self._is_root] = IDENTITY
        for active, reference in self._rounds:
            poses[active] = compose(poses.take(reference, axis=0), poses.take(active, axis=0))
        return poses


_QUATERNION_TOLERANCE = 0.01
"""The maximum deviation of a quaternion's squared length from 1 (tf2 QUATERNION_NORMALIZATION_TOLERANCE)."""

_MAX_PLANS = 64
"""The maximum number of plans. Publishers usually send the same lists of frames, so few plans are needed."""


@dataclass(frozen=True, slots=True, eq=False)
class FrameSnapshot:
    """The poses of all frames at one moment, in a fixed frame.

    Attributes:
        revision: a number that changes if and only if `names` or `parents` change.
        names: the names of the n frames.
        parents: for each frame the index of its parent, -1 for frames without a parent.
        poses: array, shape (n, 7), of each frame's pose in the fixed frame: x y z (meters) and qx qy qz qw. The rows of
            frames that no transforms connect with the fixed frame are NaN.
        ages: array, shape (n,), of the seconds since each frame's transform was last received; 0 for static transforms.
    """

    revision: int
    names: tuple[str, ...]
    parents: tuple[int, ...]
    poses: NDArray[np.float64]
    ages: NDArray[np.float64]


@dataclass(slots=True)
class _Plan:
    """The rows that store the transforms of a list of frames.

    `revision` is the revision at which the parents were last checked.
    """

    batch_rows: Rows
    rows: Rows
    parents: Rows
    revision: int = -1


class TransformBuffer:
    """A buffer of the latest transform of each frame, for displays.

    As in tf2, a frame has one parent, and the transform that was received last applies, regardless of its sender. A
    transform with another parent therefore moves the frame to that parent. Unlike tf2 there is no history: stamps are
    ignored.

    Args:
        on_problem: called once, with tf2's wording, for each kind of invalid transform of each frame.
    """

    def __init__(self, on_problem: Callable[[str], object] | None = None) -> None:
        self._on_problem = on_problem
        self._problems: set[str] = set()
        self._rows: dict[str, int] = {}
        self._parents: Rows = np.empty(0, dtype=np.intp)
        self._local: Poses = np.empty((0, 7))
        self._received_ns: NDArray[np.int64] = np.empty(0, dtype=np.int64)
        self._static: NDArray[np.bool_] = np.empty(0, dtype=np.bool_)
        self._plans: dict[tuple[tuple[str, ...], tuple[str, ...]], _Plan] = {}
        self._revision = 0
        self._root_poses: Poses | None = None
        self._rebuild_tree()

    def update(self, message: TFMessage, *, static: bool, now_ns: int) -> None:
        """Store the transforms of a message.

        Transforms with an empty frame name, with equal parent and child frames, with NaN, or with a quaternion that is
        not of unit length are ignored, as in tf2. A leading slash of a name is dropped.

        Args:
            message: the transforms.
            static: whether they were received on ``/tf_static``.
            now_ns: the current time, in nanoseconds since the epoch, for the ages of transforms.
        """
        batch = message.batch
        plan = self._get_plan(batch)
        poses = batch.poses
        batch_rows, rows, parents = plan.batch_rows, plan.rows, plan.parents
        usable = _usable_mask(poses)
        if not usable.all():
            self._report_unusable(batch, np.flatnonzero(~usable))
            is_usable = usable[batch_rows]
            batch_rows, rows, parents = batch_rows[is_usable], rows[is_usable], parents[is_usable]
        if not rows.size:
            return
        if plan.revision != self._revision:
            if not np.array_equal(self._parents[rows], parents):
                self._parents[rows] = parents
                self._rebuild_tree()
            if usable.all():
                plan.revision = self._revision
        self._local[rows] = poses.take(batch_rows, axis=0)
        self._received_ns[rows] = now_ns
        self._static[rows] = static
        self._root_poses = None

    def snapshot(self, fixed_frame: str, now_ns: int) -> FrameSnapshot:
        """Return the poses of all frames in a fixed frame.

        Args:
            fixed_frame: the frame's name; if there is no such frame, all poses are NaN.
            now_ns: the current time, in nanoseconds since the epoch.
        """
        ages = np.where(self._static | (self._parents < 0), 0.0, (now_ns - self._received_ns) / 1e9)
        np.maximum(ages, 0.0, out=ages)
        return FrameSnapshot(self._revision, self._names, self._parent_tuple, self._compute_poses_in(fixed_frame), ages)

    def lookup(self, target: str, source: str) -> Poses:
        """Return the pose of the source frame in the target frame.

        As in tf2's ``lookupTransform``, the pose transforms points from the source frame to the target frame.

        Returns:
            Array, shape (7,), of x y z (meters) and qx qy qz qw.

        Raises:
            LookupException: one of the frames is not known, or its parents form a loop.
            ConnectivityException: no transforms connect the two frames.
            InvalidArgumentException: a name is empty or starts with a slash.
        """
        target_row, source_row = self._find_row("target_frame", target), self._find_row("source_frame", source)
        roots = self._tree.roots
        for frame, row in ((target, target_row), (source, source_row)):
            if roots[row] < 0:
                raise frame_loop_error(phrase(" Frame '{frame}' is in the loop or below it.", frame=frame))
        if roots[target_row] != roots[source_row]:
            raise not_connected_error(target, source)
        poses = self._get_root_poses()
        return compose(invert(poses[target_row]), poses[source_row])

    def has_frame(self, frame: str) -> bool:
        """Return whether a frame exists."""
        return frame in self._rows

    def frames(self) -> tuple[str, ...]:
        """Return the names of all frames, in the order in which they were first seen."""
        return self._names

    def remove(self, names: Iterable[str]) -> None:
        """Remove the transforms of some frames, such as the links of a replaced robot.

        A frame that is the parent of other frames remains, but without a parent.
        """
        for row in (self._rows[name] for name in names if name in self._rows):
            self._parents[row] = -1
        is_in_use = self._parents >= 0
        is_in_use[self._parents[is_in_use]] = True
        kept_rows = np.flatnonzero(is_in_use)
        new_rows = np.full(len(is_in_use) + 1, -1, dtype=np.intp)  # one more element, so that index -1 gives -1
        new_rows[kept_rows] = np.arange(kept_rows.size)
        self._rows = {name: int(new_rows[row]) for name, row in self._rows.items() if is_in_use[row]}
        self._parents = new_rows[self._parents[kept_rows]]
        self._local = self._local[kept_rows]
        self._received_ns, self._static = self._received_ns[kept_rows], self._static[kept_rows]
        self._plans.clear()
        self._rebuild_tree()

    def clear(self) -> None:
        """Remove all transforms except the static ones, for example when time restarts."""
        is_moving = (self._parents >= 0) & ~self._static
        self.remove([name for name, row in self._rows.items() if is_moving[row]])

    def _rebuild_tree(self) -> None:
        self._revision += 1
        self._names = tuple(self._rows)
        self._parent_tuple = tuple(self._parents.tolist())
        self._tree = FrameTree(self._parents)
        self._root_poses = None

    def _find_row(self, argument: str, frame: str) -> int:
        argument = f"lookupTransform argument {argument}"
        error = frame_name_error(argument, frame)
        if error is not None:
            raise error
        row = self._rows.get(frame)
        if row is None:
            raise unknown_frame_error(argument, frame, self._names)
        return row

    def _get_root_poses(self) -> Poses:
        if self._root_poses is None:
            self._root_poses = self._tree.compute_root_poses(self._local)
        return self._root_poses

    def _compute_poses_in(self, fixed_frame: str) -> Poses:
        row = self._rows.get(fixed_frame)
        roots = self._tree.roots
        if row is None or roots[row] < 0:
            return np.full((len(self._names), 7), np.nan)
        root_poses = self._get_root_poses()
        poses = root_poses.copy() if roots[row] == row else compose(invert(root_poses[row]), root_poses)
        poses[roots != roots[row]] = np.nan
        return poses

    def _get_plan(self, batch: TransformBatch) -> _Plan:
        key = (batch.parents, batch.children)
        plan = self._plans.get(key)
        if plan is None:
            if len(self._plans) >= _MAX_PLANS:
                self._plans.clear()
            plan = self._plans[key] = self._make_plan(batch)
        return plan

    def _make_plan(self, batch: TransformBatch) -> _Plan:
        batch_rows, rows, parents = [], [], []
        for index, (parent, child) in enumerate(zip(batch.parents, batch.children, strict=True)):
            parent, child = parent.removeprefix("/"), child.removeprefix("/")
            if self._has_usable_names(parent, child):
                batch_rows.append(index)
                parents.append(self._rows.setdefault(parent, len(self._rows)))
                rows.append(self._rows.setdefault(child, len(self._rows)))
        new_count = len(self._rows) - len(self._parents)
        if new_count:
            self._parents = np.append(self._parents, np.full(new_count, -1, dtype=np.intp))
            self._local = np.vstack([self._local, np.tile(IDENTITY, (new_count, 1))])
            self._received_ns = np.append(self._received_ns, np.zeros(new_count, dtype=np.int64))
            self._static = np.append(self._static, np.zeros(new_count, dtype=np.bool_))
            self._rebuild_tree()
        return _Plan(_to_rows(batch_rows), _to_rows(rows), _to_rows(parents))

    def _has_usable_names(self, parent: str, child: str) -> bool:
        if not child:
            self._report("TF_NO_CHILD_FRAME_ID: Ignoring transform because child_frame_id not set")
        elif not parent:
            self._report(f'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "{child}" because frame_id not set')
        elif parent == child:
            self._report(
                "TF_SELF_TRANSFORM: Ignoring transform with frame_id and child_frame_id "
                f'"{child}" because they are the same'
            )
        else:
            return True
        return False

    def _report_unusable(self, batch: TransformBatch, numbers: Rows) -> None:
        for number in numbers.tolist():
            child = batch.children[number]
            if np.isnan(batch.poses[number]).any():
                self._report(
                    f'TF_NAN_INPUT: Ignoring transform for child_frame_id "{child}" '
                    "because of a nan value in the transform"
                )
            else:
                self._report(
                    f'TF_DENORMALIZED_QUATERNION: Ignoring transform for child_frame_id "{child}" '
                    "because of an invalid quaternion in the transform"
                )

    def _report(self, problem: str) -> None:
        if self._on_problem is not None and problem not in self._problems:
            self._problems.add(problem)
            self._on_problem(problem)


def _to_rows(numbers: list[int]) -> Rows:
    return np.array(numbers, dtype=np.intp)


def _usable_mask(poses: Poses) -> NDArray[np.bool_]:
    rotations = poses[:, 3:]
    squared_lengths = np.einsum("ni,ni->n", rotations, rotations)
    usable: NDArray[np.bool_] = np.abs(squared_lengths - 1.0) < _QUATERNION_TOLERANCE
    return usable & ~np.isnan(poses[:, :3]).any(axis=1)
