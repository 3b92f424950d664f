"""Random patterns for surfaces: noise, checks, stripes, dots, gradients."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Pixels = np.ndarray[Any, np.dtype[np.uint8]]


def make_random_pattern(generator: np.random.Generator, size: int, *, soft: bool) -> Pixels:
    """Return a random square pattern.

    Args:
        generator: the random generator.
        size: the side of the square in pixels.
        soft: whether the pattern is light gray, so that the surface keeps its color; else it has two random colors.

    Returns:
        The pattern in RGB, shape (size, size, 3).
    """
    kind = generator.integers(5)
    if kind == 0:
        shade = _make_noise(generator, size)
    elif kind == 1:
        shade = _make_checks(generator, size)
    elif kind == 2:
        shade = _make_stripes(generator, size)
    elif kind == 3:
        shade = _make_dots(generator, size)
    else:
        shade = _make_gradient(generator, size)
    shade = np.clip(shade + generator.normal(0.0, 0.03, shade.shape), 0.0, 1.0)[..., None]
    first_color: NDArray[np.float64]
    second_color: NDArray[np.float64]
    if soft:
        first_color, second_color = np.full(3, generator.uniform(0.55, 0.85)), np.ones(3)
    else:
        first_color, second_color = generator.uniform(0.25, 1.0, 3), generator.uniform(0.25, 1.0, 3)
    pixels: Pixels = np.round((first_color + (second_color - first_color) * shade) * 255).astype(np.uint8)
    return pixels


def make_smooth_noise(generator: np.random.Generator, cells: int, height: int, width: int) -> Any:
    """Return random values from 0 to 1, interpolated from a coarse grid, shape (height, width)."""
    grid = generator.random((cells + 1, cells + 1))
    row_positions, column_positions = (
        np.linspace(0, cells, height, endpoint=False),
        np.linspace(0, cells, width, endpoint=False),
    )
    rows = _interpolate(grid, row_positions)
    return _interpolate(rows.T, column_positions).T


def _interpolate(values: Any, positions: Any) -> Any:
    first = positions.astype(int)
    share = (positions - first)[:, None]
    return values[first] * (1 - share) + values[first + 1] * share


def _make_noise(generator: np.random.Generator, size: int) -> Any:
    shade, weight, cells = np.zeros((size, size)), 0.0, int(generator.integers(2, 6))
    for octave in range(4):
        amplitude = 0.5**octave
        shade, weight = (
            shade + amplitude * make_smooth_noise(generator, min(cells << octave, size), size, size),
            weight + amplitude,
        )
    return shade / weight


def _make_checks(generator: np.random.Generator, size: int) -> Any:
    squares = int(generator.integers(1, 9)) * 2
    indices = np.arange(size) * squares // size
    return ((indices[:, None] + indices) % 2).astype(np.float64)


def _make_stripes(generator: np.random.Generator, size: int) -> Any:
    waves = 2 * np.pi * generator.integers(1, 9) * np.arange(size) / size
    shade = np.broadcast_to(0.5 + 0.5 * np.sin(waves), (size, size))
    shade = shade if generator.random() < 0.5 else shade.T
    return np.round(shade) if generator.random() < 0.5 else shade


def _make_dots(generator: np.random.Generator, size: int) -> Any:
    count, radius = int(generator.integers(2, 9)), generator.uniform(0.15, 0.45)
    offset = (np.arange(size) * count / size) % 1.0 - 0.5
    return (offset[:, None] ** 2 + offset**2 < radius**2).astype(np.float64)


def _make_gradient(generator: np.random.Generator, size: int) -> Any:
    ramp = np.broadcast_to(np.linspace(0.0, 1.0, size), (size, size))
    return ramp if generator.random() < 0.5 else ramp.T
