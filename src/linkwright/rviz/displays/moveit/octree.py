"""Reads octrees in the format of the OctoMap library from octomap_msgs/msg/Octomap.

Both the binary and the full form store the tree from the root: each node precedes its children, and the children are
in order. The binary form has two bits for each child of an inner node: free, occupied, or an inner node. The full form
has a float with the log-odds that a node is occupied, further data of the tree's class, and a byte with one bit for
each existing child.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import phrase

_MAX_DEPTH = 16
"""The number of levels below the root. Cells of the last level have the size of the resolution."""

_FREE, _OCCUPIED, _INNER = 1, 2, 3

_NODE_BYTES = {"OcTree": 4, "ColorOcTree": 7}
"""The number of bytes of a node without its children, by the class of the tree."""

_PROBABILITIES = {_FREE: 0.1192, _OCCUPIED: 0.971}
"""The probabilities of free and occupied cells in the binary form, which are OctoMap's clamping thresholds."""

MAX_CELLS = 1_000_000
"""The largest number of cells of an octree that can be drawn."""


class BadOctreeError(ValueError):
    """Raised if the data is not a supported octree.

    The message gives the reason.
    """


@dataclass(frozen=True, slots=True)
class Cells:
    """The leaves of a tree.

    Attributes:
        centers: the centers of the cells, meters, shape (N, 3).
        sizes: the edge lengths of the cells, meters, shape (N,).
        probabilities: the probability that each cell is occupied, shape (N,).
    """

    centers: NDArray[np.float64]
    sizes: NDArray[np.float64]
    probabilities: NDArray[np.float64]

    def select(self, mask: NDArray[np.bool_]) -> Cells:
        """Return the cells that a boolean mask of shape (N,) selects."""
        return Cells(self.centers[mask], self.sizes[mask], self.probabilities[mask])


def read_octree(*, data: bytes, binary: bool, kind: str, resolution: float) -> Cells:
    """Return the leaves of an octomap_msgs/msg/Octomap, including free cells.

    Args:
        data: the bytes of the message's `data`.
        binary: whether the data has the binary form, instead of the full form.
        kind: the class of the tree, which is the message's `id`.
        resolution: the edge length of the smallest cells, meters.

    Raises:
        BadOctreeError: the data is too short or too long, or the resolution or the class is not supported.
    """
    if not (math.isfinite(resolution) and resolution > 0.0):
        raise BadOctreeError(phrase("Invalid resolution of the octomap: {resolution}", resolution=resolution))
    if not data:
        return _Leaves().to_cells(resolution, 0, data)
    try:
        return _read_binary(data, resolution) if binary else _read_full(data, kind, resolution)
    except (IndexError, struct.error):
        raise BadOctreeError(
            phrase("The data of the octomap ends too early, after {data} bytes", data=len(data))
        ) from None


def _read_binary(data: bytes, resolution: float) -> Cells:
    inner_nodes: list[_Node] = []
    states: list[int] = []
    pending = [_ROOT]
    offset = 0
    while pending:
        node = pending.pop()
        bits = data[offset] | data[offset + 1] << 8
        offset += 2
        inner_nodes.append(node)
        states.append(bits)
        inner_children = bits & bits >> 1 & 0x5555
        if inner_children:
            pending += [_make_child(node, child) for child in reversed(range(8)) if inner_children >> 2 * child & 1]
        if len(inner_nodes) > MAX_CELLS:
            raise BadOctreeError(
                phrase("The octomap has more than {maximum} cells, which are too many to draw", maximum=MAX_CELLS)
            )
    _check_is_at_end(offset, data)
    return _make_leaf_cells(np.array(inner_nodes, dtype=np.int64), np.array(states, dtype=np.int64), resolution)


def _make_leaf_cells(inner_nodes: NDArray[np.int64], bits: NDArray[np.int64], resolution: float) -> Cells:
    """Return the leaves among the children of inner nodes.

    Args:
        inner_nodes: the inner nodes, shape (N, 4): x, y and z of the center, and the edge length, in halves of
            `resolution`.
        bits: for each inner node, the states of its eight children, two bits each.
        resolution: the edge length of the smallest cells, meters.

    Raises:
        BadOctreeError: there are too many cells or levels.
    """
    states = bits[:, None] >> 2 * np.arange(8) & 3
    parents, children = np.nonzero((states == _FREE) | (states == _OCCUPIED))
    if len(parents) > MAX_CELLS:
        raise BadOctreeError(
            phrase("The octomap has more than {maximum} cells, which are too many to draw", maximum=MAX_CELLS)
        )
    edges = inner_nodes[parents, 3]
    if (edges <= 2).any():
        raise BadOctreeError(phrase("The octomap has more than {depth} levels", depth=_MAX_DEPTH))
    signs = (children[:, None] >> np.arange(3) & 1) * 2 - 1
    centers = inner_nodes[parents, :3] + signs * (edges // 4)[:, None]
    half_resolution = resolution / 2.0
    probabilities = np.where(states[parents, children] == _FREE, _PROBABILITIES[_FREE], _PROBABILITIES[_OCCUPIED])
    return Cells(centers * half_resolution, edges // 2 * half_resolution, probabilities)


def _read_full(data: bytes, kind: str, resolution: float) -> Cells:
    node_bytes = _NODE_BYTES.get(kind)
    if node_bytes is None:
        known_types = ", ".join(_NODE_BYTES)
        raise BadOctreeError(
            phrase(
                "Octomaps of type '{kind}' are not supported; the supported types are {known}",
                kind=kind,
                known=known_types,
            )
        )
    leaves = _Leaves()
    pending = [_ROOT]
    offset = 0
    while pending:
        node = pending.pop()
        (log_odds,) = struct.unpack_from("<f", data, offset)
        children = data[offset + node_bytes]
        offset += node_bytes + 1
        if not children:
            leaves.add(node, 1.0 / (1.0 + math.exp(-max(-50.0, min(50.0, log_odds)))))
        else:
            pending += [_make_child(node, child) for child in reversed(range(8)) if children >> child & 1]
    return leaves.to_cells(resolution, offset, data)


_Node = tuple[int, int, int, int]
"""The center x, y, z of a node and its edge length, in units of half the edge of the smallest cells."""

_ROOT: _Node = (0, 0, 0, 2 << _MAX_DEPTH)


def _make_child(node: _Node, child: int) -> _Node:
    x, y, z, edge = node
    if edge <= 2:
        raise BadOctreeError(phrase("The octomap has more than {depth} levels", depth=_MAX_DEPTH))
    distance = edge // 4
    return (
        x + (distance if child & 1 else -distance),
        y + (distance if child & 2 else -distance),
        z + (distance if child & 4 else -distance),
        edge // 2,
    )


class _Leaves:
    """The leaves of an octree, collected while the tree is read."""

    def __init__(self) -> None:
        self._nodes: list[_Node] = []
        self._probabilities: list[float] = []

    def add(self, node: _Node, probability: float) -> None:
        if len(self._nodes) == MAX_CELLS:
            raise BadOctreeError(
                phrase("The octomap has more than {maximum} cells, which are too many to draw", maximum=MAX_CELLS)
            )
        self._nodes.append(node)
        self._probabilities.append(probability)

    def to_cells(self, resolution: float, offset: int, data: bytes) -> Cells:
        _check_is_at_end(offset, data)
        nodes = np.array(self._nodes, dtype=np.float64).reshape(-1, 4) * (resolution / 2.0)
        return Cells(nodes[:, :3], nodes[:, 3], np.array(self._probabilities, dtype=np.float64))


def _check_is_at_end(offset: int, data: bytes) -> None:
    if offset != len(data):
        raise BadOctreeError(
            phrase("The octree ends after {count} of {total} bytes of data", count=offset, total=len(data))
        )
