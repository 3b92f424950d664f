"""Plot the results of a sweep in SVG."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from math import ceil, floor, log10

import numpy as np

_WIDTH, _HEIGHT = 360.0, 220.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 56.0, 12.0, 12.0, 40.0
_MAX_BARS = 24
_MAX_POINTS = 2000
"""The maximum number of runs that are drawn. Of more runs, only every n-th is drawn."""
_POINT_RADIUS_PX = 3.0


@dataclass(frozen=True)
class Axis:
    """An axis of a plot.

    Calling an axis converts a value to a coordinate in the drawing.

    Attributes:
        low, high: the values at both ends.
        ticks: the values of the ticks, with their labels.
        begin, end: the coordinates of both ends.
    """

    low: float
    high: float
    ticks: Sequence[tuple[float, str]]
    begin: float
    end: float

    @classmethod
    def for_numbers(cls, values: Sequence[float], begin: float, end: float, *, from_zero: bool = False) -> Axis:
        """Return an axis that covers all values, with ticks at round numbers."""
        low, high = min(values), max(values)
        if from_zero:
            low = 0.0
        if low == high:
            margin = abs(low) * 0.05 or 0.5
            low, high = low - margin, high + margin
        step = _choose_step((high - low) / 4)
        if not from_zero:
            low = floor(low / step) * step
        high = ceil(high / step) * step
        ticks = [(low + step * index, f"{low + step * index:.6g}") for index in range(round((high - low) / step) + 1)]
        return cls(
            low,
            high,
            [(0.0 if abs(position) < step * 1e-9 else position, text) for position, text in ticks],
            begin,
            end,
        )

    @classmethod
    def of_names(cls, names: Sequence[str], begin: float, end: float) -> Axis:
        """Return an axis with a position for each name.

        The first position has the value 0.
        """
        return cls(-0.5, len(names) - 0.5, [(float(index), name) for index, name in enumerate(names)], begin, end)

    def __call__(self, value: float) -> float:
        """Return the coordinate of a value in the drawing."""
        return self.begin + (value - self.low) / (self.high - self.low) * (self.end - self.begin)


def draw_histogram(values: Sequence[float], label: str) -> str:
    """Return a histogram of the values of a result, in SVG."""
    counts, edges = np.histogram(np.asarray(values, dtype=float), bins=min(_MAX_BARS, max(len(set(values)), 5)))
    x_axis = Axis.for_numbers([float(edges[0]), float(edges[-1])], _LEFT, _WIDTH - _RIGHT)
    y_axis = Axis.for_numbers([float(counts.max())], _HEIGHT - _BOTTOM, _TOP, from_zero=True)
    bars = []
    for count, left, right in zip(counts.tolist(), edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        if count:
            x, y = x_axis(left), y_axis(count)
            bars.append(
                f'<rect class="bar" x="{x:.1f}" y="{y:.1f}" width="{max(x_axis(right) - x - 1, 1):.1f}" '
                f'height="{y_axis(0) - y:.1f}"><title>{left:.6g} … {right:.6g}: {count}</title></rect>'
            )
    return _draw_plot(x_axis, y_axis, label, "".join(bars))


def draw_scatter(
    parameter_values: Sequence[object],
    values: Sequence[float],
    rows: Sequence[object],
    parameter_label: str,
    label: str,
) -> str:
    """Return a scatter plot of a result against a parameter, in SVG.

    The plot has a point for each run, up to `_MAX_POINTS`, and a line through the mean results of equal parameter
    values.
    """
    is_numeric = all(isinstance(value, int | float) and not isinstance(value, bool) for value in parameter_values)
    names = [] if is_numeric else list(dict.fromkeys(map(str, parameter_values)))
    positions = [
        float(value) if is_numeric else float(names.index(str(value)))  # type: ignore[arg-type]
        for value in parameter_values
    ]
    x_axis = (
        Axis.for_numbers(positions, _LEFT, _WIDTH - _RIGHT)
        if is_numeric
        else Axis.of_names(names, _LEFT, _WIDTH - _RIGHT)
    )
    y_axis = Axis.for_numbers(values, _HEIGHT - _BOTTOM, _TOP)
    drawn_indices = range(0, len(values), -(-len(values) // _MAX_POINTS))
    points = "".join(
        f'<a href="#row-{rows[index]}"><circle class="point" cx="{x_axis(positions[index]):.1f}" '
        f'cy="{y_axis(values[index]):.1f}" r="{_POINT_RADIUS_PX}"><title>{rows[index]}: '
        f"{escape(str(parameter_values[index]))}, {values[index]:.6g}</title></circle></a>"
        for index in drawn_indices
    )
    return _draw_plot(
        x_axis, y_axis, label, _draw_mean_line(positions, values, x_axis, y_axis) + points, parameter_label
    )


def _draw_mean_line(positions: Sequence[float], values: Sequence[float], x_axis: Axis, y_axis: Axis) -> str:
    """Return a line through the mean of the values at each position, in SVG.

    The line is empty if there is only one position, or if there are few values for each position.
    """
    groups: dict[float, list[float]] = {}
    for position, value in zip(positions, values, strict=True):
        groups.setdefault(position, []).append(value)
    if len(groups) < 2 or len(groups) > len(values) / 2:
        return ""
    line = " ".join(
        f"{x_axis(position):.1f},{y_axis(sum(group) / len(group)):.1f}" for position, group in sorted(groups.items())
    )
    return f'<polyline class="mean" points="{line}"/>'


def _draw_plot(x_axis: Axis, y_axis: Axis, label: str, content: str, x_label: str = "") -> str:
    lines = []
    for value, text in y_axis.ticks:
        y = y_axis(value)
        lines.append(
            f'<line class="grid" x1="{_LEFT}" x2="{_WIDTH - _RIGHT}" y1="{y:.1f}" y2="{y:.1f}"/>'
            f'<text class="tick" x="{_LEFT - 6}" y="{y + 3.5:.1f}" text-anchor="end">{escape(text)}</text>'
        )
    for value, text in x_axis.ticks:
        lines.append(
            f'<text class="tick" x="{x_axis(value):.1f}" y="{_HEIGHT - _BOTTOM + 15:.1f}" text-anchor="middle">'
            f"{escape(text if len(text) < 24 else f'…{text[-22:]}')}</text>"
        )
    title = f"{label} – {x_label}" if x_label else label
    axis_label = escape(x_label or label)
    return (
        f'<svg viewBox="0 0 {_WIDTH:g} {_HEIGHT:g}" role="img" aria-label="{escape(title)}">{"".join(lines)}'
        f'<line class="axis" x1="{_LEFT}" x2="{_WIDTH - _RIGHT}" y1="{_HEIGHT - _BOTTOM}" y2="{_HEIGHT - _BOTTOM}"/>'
        f'<text class="label" x="{(_LEFT + _WIDTH - _RIGHT) / 2}" y="{_HEIGHT - 6}" '
        f'text-anchor="middle">{axis_label}</text>'
        f"{content}</svg>"
    )


def _choose_step(minimum: float) -> float:
    """Return the smallest number 1, 2 or 5 times a power of ten that is not less than a minimum."""
    power = 10.0 ** floor(log10(minimum))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= minimum * (1 - 1e-9))
