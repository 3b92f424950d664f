"""Reads octrees in the format in which the OctoMap library writes them to octomap_msgs/msg/Octomap.

Both the binary and the full form store the tree from the root, each node before its children and the children in
order. The binary form has two bits for each child of an inner node: free, occupied, or an inner node. The full form has
a float with the log-odds that a node is occupied, further data of the tree's class, and a byte with one bit for each
existing child.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import phrase

_DEPTH = 16
"""Levels below the root; cells of the last have the resolution."""

_FREE, _OCCUPIED, _INNER = 1, 2, 3

_FULL_NODES = {"OcTree": 4, "ColorOcTree": 7}
"""Bytes of a node, by the class of the tree."""

_CLAMPED = {_FREE: 0.1192, _OCCUPIED: 0.971}
"""The probabilities that the binary form encodes: OctoMap's clamping thresholds."""

MOST_CELLS = 1_000_000
"""The largest number of cells drawn."""


class BadOctreeError(ValueError):
    """Raised when the data is not an octree; the message gives the reason."""


@dataclass(frozen=True, slots=True)
class Cells:
    """The leaves of a tree.

    Attributes:
        centers: the centres of the cells, metres, shape (N, 3).
        sizes: edge lengths, metres, shape (N,).
        probabilities: the probability that each cell is occupied, shape (N,).
    """

    centers: NDArray[np.float64]
    sizes: NDArray[np.float64]
    probabilities: NDArray[np.float64]

    def chosen(self, mask: NDArray[np.bool_]) -> Cells:
        """Return the cells for which a boolean mask of shape (N,) is True."""
        return Cells(self.centers[mask], self.sizes[mask], self.probabilities[mask])


def read_octree(*, data: bytes, binary: bool, kind: str, resolution: float) -> Cells:
    """Return the leaves of an octomap_msgs/msg/Octomap, including free ones.

    Args:
        data: the bytes of the message's `data`.
        binary: whether the data has the binary form, instead of the full form.
        kind: the class of the tree, which is the message's `id`.
        resolution: the edge length of the smallest cells, metres.

    Raises:
        BadOctreeError: the data is too short or too long, or the class is unknown.
    """
    if not (math.isfinite(resolution) and resolution > 0.0):
        raise BadOctreeError(phrase("Invalid resolution of the octomap: {resolution}", resolution=resolution))
    if not data:
        return _Leaves().cells(resolution, 0, data)
    try:
        return _read_binary(data, resolution) if binary else _read_full(data, kind, resolution)
    except (IndexError, struct.error):
        raise BadOctreeError(
            phrase("The data of the octomap ends too early, after {data} bytes", data=len(data))
        ) from None


def _read_binary(data: bytes, resolution: float) -> Cells:
    inner: list[_Node] = []
    states: list[int] = []
    pending = [_ROOT]
    at = 0
    while pending:
        node = pending.pop()
        bits = data[at] | data[at + 1] << 8
        at += 2
        inner.append(node)
        states.append(bits)
        deeper = bits & bits >> 1 & 0x5555
        if deeper:
            pending += [_child(node, child) for child in reversed(range(8)) if deeper >> 2 * child & 1]
        if len(inner) > MOST_CELLS:
            raise BadOctreeError(phrase("The octomap has more than {most} cells", most=MOST_CELLS))
    _check_end(at, data)
    return _leaves_of(np.array(inner, dtype=np.int64), np.array(states, dtype=np.int64), resolution)


def _leaves_of(inner: NDArray[np.int64], bits: NDArray[np.int64], resolution: float) -> Cells:
    """Return the leaves among the children of inner nodes.

    Args:
        inner: the inner nodes, shape (N, 4).
        bits: for each inner node, the states of its eight children, two bits each.
        resolution: the edge length of the smallest cells, metres.
    """
    states = bits[:, None] >> 2 * np.arange(8) & 3
    parents, children = np.nonzero((states == _FREE) | (states == _OCCUPIED))
    if len(parents) > MOST_CELLS:
        raise BadOctreeError(phrase("The octomap has more than {most} cells", most=MOST_CELLS))
    edges = inner[parents, 3]
    if (edges <= 2).any():
        raise BadOctreeError(phrase("The octomap is deeper than {depth} levels", depth=_DEPTH))
    signs = (children[:, None] >> np.arange(3) & 1) * 2 - 1
    centers = inner[parents, :3] + signs * (edges // 4)[:, None]
    half = resolution / 2.0
    probabilities = np.where(states[parents, children] == _FREE, _CLAMPED[_FREE], _CLAMPED[_OCCUPIED])
    return Cells(centers * half, edges // 2 * half, probabilities)


def _read_full(data: bytes, kind: str, resolution: float) -> Cells:
    size = _FULL_NODES.get(kind)
    if size is None:
        known = ", ".join(_FULL_NODES)
        raise BadOctreeError(
            phrase("Unknown octomap type: '{kind}'; the known types are {known}", kind=kind, known=known)
        )
    leaves = _Leaves()
    pending = [_ROOT]
    at = 0
    while pending:
        node = pending.pop()
        (logarithm,) = struct.unpack_from("<f", data, at)
        children = data[at + size]
        at += size + 1
        if not children:
            leaves.add(node, 1.0 / (1.0 + math.exp(-max(-50.0, min(50.0, logarithm)))))
        else:
            pending += [_child(node, child) for child in reversed(range(8)) if children >> child & 1]
    return leaves.cells(resolution, at, data)


_Node = tuple[int, int, int, int]
"""The centre of a node and its edge, both in half edges of the smallest cells."""

_ROOT: _Node = (0, 0, 0, 2 << _DEPTH)


def _child(node: _Node, child: int) -> _Node:
    x, y, z, edge = node
    if edge <= 2:
        raise BadOctreeError(phrase("The octomap is deeper than {depth} levels", depth=_DEPTH))
    away = edge // 4
    return (
        x + (away if child & 1 else -away),
        y + (away if child & 2 else -away),
        z + (away if child & 4 else -away),
        edge // 2,
    )


class _Leaves:
    """Collects the leaves of an octree while the tree is read."""

    def __init__(self) -> None:
        self._nodes: list[_Node] = []
        self._probabilities: list[float] = []

    def add(self, node: _Node, probability: float) -> None:
        if len(self._nodes) == MOST_CELLS:
            raise BadOctreeError(phrase("The octomap has more than {most} cells", most=MOST_CELLS))
        self._nodes.append(node)
        self._probabilities.append(probability)

    def cells(self, resolution: float, at: int, data: bytes) -> Cells:
        _check_end(at, data)
        nodes = np.array(self._nodes, dtype=np.float64).reshape(-1, 4) * (resolution / 2.0)
        return Cells(nodes[:, :3], nodes[:, 3], np.array(self._probabilities, dtype=np.float64))


def _check_end(at: int, data: bytes) -> None:
    if at != len(data):
        raise BadOctreeError(phrase("The octomap ends after {at} of {data} bytes", at=at, data=len(data)))
