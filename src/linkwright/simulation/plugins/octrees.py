"""Writes octrees in the binary form of the OctoMap library.

The tree is stored from the root: each inner node precedes its inner children, and has two bits for each child: free,
occupied, or an inner node. Eight children with the same state are merged.
"""

from __future__ import annotations

from typing import Any

import numpy as np

_DEPTH = 16
_HALF = 1 << (_DEPTH - 1)
_INNER = 3


def encode_octree(first_key: Any, states: Any) -> tuple[bytes, int]:
    """Return the bytes of an octree, and the number of its nodes.

    Args:
        first_key: the position of the first cell in cells from the origin of the map, shape (3,).
        states: the state of each cell, shape (cells along x, y, z): 0 unknown, 1 free, 2 occupied.

    Cells outside of the tree, 32768 cells from the origin, are left out.
    """
    cells = np.argwhere(states)
    values = states[tuple(cells.T)].astype(np.int64)
    keys = cells + np.asarray(first_key) + _HALF
    is_inside = ((keys >= 0) & (keys < 2 * _HALF)).all(axis=1)
    codes, values = _interleave(keys[is_inside]), values[is_inside]
    if not len(codes):
        return b"", 0
    order = np.argsort(codes)
    codes, values = codes[order], values[order]
    node_count, starts, levels, records = len(codes), [], [], []
    for level in range(1, _DEPTH + 1):
        parents, first = np.unique(codes >> 3, return_index=True)
        bits = np.bitwise_or.reduceat(values << 2 * (codes & 7), first)
        is_merged = np.zeros(len(parents), dtype=bool)
        if level < _DEPTH:
            is_merged = (bits == 0x5555) | (bits == 0xAAAA)
        node_count += len(parents) - 8 * int(is_merged.sum())
        starts.append(parents[~is_merged] << 3 * level)
        levels.append(np.full(int((~is_merged).sum()), level))
        records.append(bits[~is_merged])
        codes, values = parents, np.where(is_merged, bits & 3, _INNER)
    order = np.lexsort((-np.concatenate(levels), np.concatenate(starts)))
    return np.concatenate(records)[order].astype("<u2").tobytes(), node_count


def _interleave(keys: Any) -> Any:
    """Return the numbers of cells in the order of the tree, in which x is the lowest of each three bits."""
    codes = np.zeros(len(keys), dtype=np.int64)
    for bit in range(_DEPTH):
        for axis in range(3):
            codes |= (keys[:, axis] >> bit & 1) << 3 * bit + axis
    return codes
