"""Vector arithmetic with bit-identical results on every machine.

Sums are written out term by term. `numpy.linalg.norm`, `numpy.dot` and `numpy.sum` add in an order that depends on the
processor and on the version of numpy.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Vector3, length, scaled

Indices = NDArray[np.int64]
Floats = NDArray[Any]


def dot_products(first: Floats, second: Floats) -> Floats:
    """Return the dot products of vectors, shape (..., 3), as shape (...)."""
    products: Floats = first[..., 0] * second[..., 0] + first[..., 1] * second[..., 1] + first[..., 2] * second[..., 2]
    return products


def along(vectors: Floats, direction: Vector3) -> Floats:
    """Return the components of vectors, shape (n, 3), along a direction, shape (n,)."""
    x, y, z = direction
    components: Floats = vectors[:, 0] * x + vectors[:, 1] * y + vectors[:, 2] * z
    return components


def cross_products(first: Floats, second: Floats) -> Floats:
    """Return the cross products of vectors of shape (n, 3)."""
    product = np.empty(first.shape, first.dtype)
    for axis in range(3):
        second_axis, third_axis = (axis + 1) % 3, (axis + 2) % 3
        product[:, axis] = first[:, second_axis] * second[:, third_axis] - first[:, third_axis] * second[:, second_axis]
    return product


def unit_vectors(vectors: Floats) -> Floats:
    """Return vectors of shape (n, 3) scaled to length 1; a zero vector remains zero."""
    lengths = np.sqrt(dot_products(vectors, vectors))
    units: Floats = vectors / np.where(lengths > 0, lengths, 1.0).astype(vectors.dtype)[:, None]
    return units


def unit_vector(vector: Vector3) -> Vector3:
    """Return a vector scaled to length 1."""
    return scaled(vector, 1.0 / length(vector))


def sum_by_index(indices: Indices, vectors: Floats, count: int) -> Array:
    """Sum the vectors that have the same index, one after the other, shape (count, 3)."""
    return np.stack([np.bincount(indices, vectors[:, axis], count) for axis in range(3)], axis=1)


def repeat_indices(counts: Indices) -> tuple[Indices, Indices]:
    """Return the item index of each repetition, and its number from 0, for repetition counts."""
    items = np.repeat(np.arange(len(counts)), counts)
    starts = np.cumsum(counts) - counts
    return items, np.arange(len(items)) - starts[items]
