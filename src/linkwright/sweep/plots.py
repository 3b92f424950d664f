"""Plots of a sweep in SVG."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from math import ceil, floor, log10

import numpy as np

_WIDTH, _HEIGHT = 360.0, 220.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 56.0, 12.0, 12.0, 40.0
_BARS = 24
_MOST_POINTS = 2000
"""The most runs that are drawn; of more runs every n-th is drawn."""
_RADIUS = 3.0


@dataclass(frozen=True)
class Axis:
    """An axis of a plot, which maps values to coordinates in the drawing.

    Attributes:
        low, high: the values at the two ends.
        ticks: the positions of the ticks with their labels.
        begin, end: the coordinates of the two ends.
    """

    low: float
    high: float
    ticks: Sequence[tuple[float, str]]
    begin: float
    end: float

    @classmethod
    def of_numbers(cls, values: Sequence[float], begin: float, end: float, *, from_zero: bool = False) -> Axis:
        """Return an axis that covers all values, with ticks at round numbers."""
        low, high = min(values), max(values)
        if from_zero:
            low = 0.0
        if low == high:
            margin = abs(low) * 0.05 or 0.5
            low, high = low - margin, high + margin
        step = _round_step((high - low) / 4)
        if not from_zero:
            low = floor(low / step) * step
        high = ceil(high / step) * step
        ticks = [
            (low + step * number, f"{low + step * number:.6g}") for number in range(round((high - low) / step) + 1)
        ]
        return cls(low, high, [(0.0 if abs(place) < step * 1e-9 else place, text) for place, text in ticks], begin, end)

    @classmethod
    def of_names(cls, names: Sequence[str], begin: float, end: float) -> Axis:
        """Return an axis with a position for each name; the first has the value 0."""
        return cls(-0.5, len(names) - 0.5, [(float(place), name) for place, name in enumerate(names)], begin, end)

    def __call__(self, value: float) -> float:
        """Return the coordinate of a value in the drawing."""
        return self.begin + (value - self.low) / (self.high - self.low) * (self.end - self.begin)


def histogram(values: Sequence[float], label: str) -> str:
    """Return a histogram of the values of a result, in SVG."""
    counts, edges = np.histogram(np.asarray(values, dtype=float), bins=min(_BARS, max(len(set(values)), 5)))
    across = Axis.of_numbers([float(edges[0]), float(edges[-1])], _LEFT, _WIDTH - _RIGHT)
    upwards = Axis.of_numbers([float(counts.max())], _HEIGHT - _BOTTOM, _TOP, from_zero=True)
    bars = []
    for count, left, right in zip(counts.tolist(), edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        if count:
            x, y = across(left), upwards(count)
            bars.append(
                f'<rect class="bar" x="{x:.1f}" y="{y:.1f}" width="{max(across(right) - x - 1, 1):.1f}" '
                f'height="{upwards(0) - y:.1f}"><title>{left:.6g} … {right:.6g}: {count}</title></rect>'
            )
    return _drawing(across, upwards, label, "".join(bars))


def scatter(
    across_values: Sequence[object], values: Sequence[float], rows: Sequence[object], across_label: str, label: str
) -> str:
    """Return a scatter plot of a result against a parameter, in SVG.

    The plot has a point for each run, and a line through the mean results of equal parameter values.
    """
    numbers = all(isinstance(value, int | float) and not isinstance(value, bool) for value in across_values)
    names = [] if numbers else list(dict.fromkeys(map(str, across_values)))
    places = [
        float(value) if numbers else float(names.index(str(value)))  # type: ignore[arg-type]
        for value in across_values
    ]
    across = (
        Axis.of_numbers(places, _LEFT, _WIDTH - _RIGHT) if numbers else Axis.of_names(names, _LEFT, _WIDTH - _RIGHT)
    )
    upwards = Axis.of_numbers(values, _HEIGHT - _BOTTOM, _TOP)
    chosen = range(0, len(values), -(-len(values) // _MOST_POINTS))
    points = "".join(
        f'<a href="#row-{rows[index]}"><circle class="point" cx="{across(places[index]):.1f}" '
        f'cy="{upwards(values[index]):.1f}" r="{_RADIUS}"><title>{rows[index]}: '
        f"{escape(str(across_values[index]))}, {values[index]:.6g}</title></circle></a>"
        for index in chosen
    )
    return _drawing(across, upwards, label, _means(places, values, across, upwards) + points, across_label)


def _means(places: Sequence[float], values: Sequence[float], across: Axis, upwards: Axis) -> str:
    """Return a line through the mean of the values at each position, in SVG.

    The result is empty if too few positions have several values.
    """
    groups: dict[float, list[float]] = {}
    for place, value in zip(places, values, strict=True):
        groups.setdefault(place, []).append(value)
    if len(groups) < 2 or len(groups) > len(values) / 2:
        return ""
    line = " ".join(
        f"{across(place):.1f},{upwards(sum(group) / len(group)):.1f}" for place, group in sorted(groups.items())
    )
    return f'<polyline class="mean" points="{line}"/>'


def _drawing(across: Axis, upwards: Axis, label: str, content: str, across_label: str = "") -> str:
    lines = []
    for value, text in upwards.ticks:
        y = upwards(value)
        lines.append(
            f'<line class="grid" x1="{_LEFT}" x2="{_WIDTH - _RIGHT}" y1="{y:.1f}" y2="{y:.1f}"/>'
            f'<text class="tick" x="{_LEFT - 6}" y="{y + 3.5:.1f}" text-anchor="end">{escape(text)}</text>'
        )
    for value, text in across.ticks:
        lines.append(
            f'<text class="tick" x="{across(value):.1f}" y="{_HEIGHT - _BOTTOM + 15:.1f}" text-anchor="middle">'
            f"{escape(text if len(text) < 24 else f'…{text[-22:]}')}</text>"
        )
    title = f"{label} – {across_label}" if across_label else label
    below = escape(across_label or label)
    return (
        f'<svg viewBox="0 0 {_WIDTH:g} {_HEIGHT:g}" role="img" aria-label="{escape(title)}">{"".join(lines)}'
        f'<line class="axis" x1="{_LEFT}" x2="{_WIDTH - _RIGHT}" y1="{_HEIGHT - _BOTTOM}" y2="{_HEIGHT - _BOTTOM}"/>'
        f'<text class="label" x="{(_LEFT + _WIDTH - _RIGHT) / 2}" y="{_HEIGHT - 6}" text-anchor="middle">{below}</text>'
        f"{content}</svg>"
    )


def _round_step(least: float) -> float:
    """Return the smallest number of the form 1, 2 or 5 times a power of ten that is at least `least`."""
    power = 10.0 ** floor(log10(least))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= least * (1 - 1e-9))
