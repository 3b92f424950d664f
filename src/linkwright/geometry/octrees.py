"""Writes octrees in the two forms of the OctoMap library.

A cell has a key: its number along x, y and z. A tree is stored from the root, each node before its children. In the
binary form, each inner node has two bits for each child: free, occupied, or an inner node. In the full form, each node
has the log-odds that it is occupied, and a bit for each child that exists. Eight children with the same state are
merged.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

DEPTH = 16
"""The number of levels below the root."""
_HALF = 1 << (DEPTH - 1)
_INNER = 3
FREE, OCCUPIED = 1, 2
"""States of cells; 0 is unknown."""

Codes = NDArray[np.int64]
"""Numbers of cells in the order of the tree, in which x is the lowest of each three bits."""


def codes_of_keys(keys: NDArray[np.int64]) -> tuple[Codes, NDArray[np.bool_]]:
    """Return the codes of the cells inside of the tree, and a mask of these cells.

    Args:
        keys: the positions in cells from the origin of the map, shape (n, 3), at most 32768 from the origin.
    """
    shifted = keys + _HALF
    is_inside: NDArray[np.bool_] = np.all((shifted >= 0) & (shifted < 2 * _HALF), axis=1)
    inside = shifted[is_inside]
    codes: Codes = np.zeros(len(inside), dtype=np.int64)
    for bit in range(DEPTH):
        for axis in range(3):
            codes |= (inside[:, axis] >> bit & 1) << 3 * bit + axis
    return codes, is_inside


def keys_of_codes(codes: Codes, depth: int = DEPTH) -> NDArray[np.int64]:
    """Return the keys of the first smallest cell in nodes at a depth, shape (n, 3)."""
    keys = np.zeros((len(codes), 3), dtype=np.int64)
    for bit in range(depth):
        for axis in range(3):
            keys[:, axis] |= (codes >> 3 * bit + axis & 1) << bit + DEPTH - depth
    return keys - _HALF


def encode_octree(first_key: Any, states: Any) -> tuple[bytes, int]:
    """Return the bytes of an octree in the binary form, and the number of its nodes.

    Args:
        first_key: the position of the first cell in cells from the origin of the map, shape (3,).
        states: the state of each cell, shape (cells along x, y, z): 0 unknown, 1 free, 2 occupied.

    Cells outside of the tree, 32768 cells from the origin, are left out.
    """
    cells = np.argwhere(states)
    values = states[tuple(cells.T)].astype(np.int64)
    codes, is_inside = codes_of_keys(cells + np.asarray(first_key))
    order = np.argsort(codes)
    return encode_states(codes[order], values[is_inside][order])


def encode_states(codes: Codes, values: NDArray[np.int64]) -> tuple[bytes, int]:
    """Return the bytes of an octree in the binary form, and the number of its nodes.

    Args:
        codes: the cells in ascending order, shape (n,).
        values: the states `FREE` or `OCCUPIED`, shape (n,).
    """
    if not len(codes):
        return b"", 0
    node_count, starts, levels, records = len(codes), [], [], []
    for level in range(1, DEPTH + 1):
        parents, first = np.unique(codes >> 3, return_index=True)
        bits = np.bitwise_or.reduceat(values << 2 * (codes & 7), first)
        is_merged = np.zeros(len(parents), dtype=bool)
        if level < DEPTH:
            is_merged = (bits == 0x5555) | (bits == 0xAAAA)
        node_count += len(parents) - 8 * int(is_merged.sum())
        starts.append(parents[~is_merged] << 3 * level)
        levels.append(np.full(int((~is_merged).sum()), level))
        records.append(bits[~is_merged])
        codes, values = parents, np.where(is_merged, bits & 3, _INNER)
    order = np.lexsort((-np.concatenate(levels), np.concatenate(starts)))
    return np.concatenate(records)[order].astype("<u2").tobytes(), node_count


@dataclass(frozen=True, slots=True, eq=False)
class Level:
    """The nodes of a tree at one depth, in ascending order.

    Attributes:
        depth: the depth, 0 for the root.
        codes: the codes of the nodes, with three bits for each level, shape (n,).
        values: the log-odds of the nodes, shape (n,).
        children: a bit for each child that exists, shape (n,); 0 for leaves.
    """

    depth: int
    codes: Codes
    values: NDArray[np.float32]
    children: NDArray[np.uint8]

    def select(self, mask: NDArray[np.bool_]) -> Level:
        """Return some of the nodes."""
        return Level(self.depth, self.codes[mask], self.values[mask], self.children[mask])


def build_levels(codes: Codes, values: NDArray[np.float32], *, merges: bool = True) -> list[Level]:
    """Return the levels of a tree from the root to the smallest cells.

    The value of an inner node is the largest one of its children.

    Args:
        codes: the smallest cells in ascending order, shape (n,).
        values: their log-odds, shape (n,).
        merges: whether eight leaves with equal values become one.
    """
    level = Level(DEPTH, codes, values, np.zeros(len(codes), dtype=np.uint8))
    levels: list[Level] = []
    for depth in range(DEPTH - 1, -1, -1):
        if not len(level.codes):
            levels.append(level)
            level = Level(depth, level.codes, level.values, level.children)
            continue
        parents, first, index = np.unique(level.codes >> 3, return_index=True, return_inverse=True)
        bits = (1 << (level.codes & 7)).astype(np.uint8)
        children = np.bitwise_or.reduceat(bits, first)
        highest = np.maximum.reduceat(level.values, first)
        is_merged = np.zeros(len(parents), dtype=bool)
        if merges:
            is_merged = (children == 255) & (highest == np.minimum.reduceat(level.values, first))
            is_merged &= np.maximum.reduceat(level.children, first) == 0
        levels.append(level.select(~is_merged[index]))
        level = Level(depth, parents, highest, np.where(is_merged, np.uint8(0), children))
    return [level, *reversed(levels)]


def encode_levels(levels: list[Level]) -> bytes:
    """Return the bytes of a tree in the full form."""
    codes = np.concatenate([level.codes << 3 * (DEPTH - level.depth) for level in levels])
    depths = np.concatenate([np.full(len(level.codes), level.depth) for level in levels])
    records = np.zeros(len(codes), dtype=[("value", "<f4"), ("children", "u1")])
    records["value"] = np.concatenate([level.values for level in levels])
    records["children"] = np.concatenate([level.children for level in levels])
    data: bytes = records[np.lexsort((depths, codes))].tobytes()
    return data
