"""Plot the paths of robots in both versions as SVG in HTML."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from html import escape
from math import ceil, floor, log10

from linkwright.diagnostics import Phrase, phrase
from linkwright.diagnostics.translation import localized
from linkwright.review.paths import PathComparison, PathPair, Points

PLOT_STYLE = """
:root { --old: #2f6fb0; --new: #d9541e; }
@media (prefers-color-scheme: dark) { :root { --old: #6ba3dc; --new: #ff8f66; } }
.plot { margin: 16px 0; overflow-x: auto; } .plot strong { color: var(--ink); }
.plot > svg { display: block; width: 100%; height: auto; min-width: 520px; max-width: 860px; }
.plot figcaption, .plot .legend { display: flex; flex-wrap: wrap; gap: 2px 18px; justify-content: flex-start; }
.plot .legend span { display: inline-flex; align-items: center; gap: 6px; }
.plot .legend svg { width: 26px; height: 12px; }
.plot .grid { stroke: var(--line); } .plot .tick { font-size: 11px; fill: var(--soft); }
.plot .path { fill: none; stroke-linejoin: round; stroke-linecap: round; }
.plot .old { stroke: var(--old); } .plot .new { stroke: var(--new); }
.plot .thin { stroke-width: 1; stroke-opacity: .5; } .plot .old.thick { stroke-width: 4; stroke-opacity: .8; }
.plot .new.thick { stroke-width: 2; }
.plot .end.old { fill: var(--old); } .plot .end.new { fill: var(--new); }
.plot .end, .plot .start { stroke: var(--card); stroke-width: 1.5; } .plot .start { fill: var(--ink); }
.plot .apart { stroke: var(--ink); stroke-width: 1.5; stroke-dasharray: 4 3; }
.plot .note { font-size: 12px; fill: var(--ink); paint-order: stroke; stroke: var(--card); stroke-width: 4px; }
"""

_WIDTH = 860.0
_LEFT_MARGIN, _RIGHT_MARGIN, _TOP_MARGIN, _BOTTOM_MARGIN = 52.0, 16.0, 12.0, 38.0
_MAX_HEIGHT, _MIN_HEIGHT = 440.0, 150.0
"""The limits of the height of the area with the paths."""
_MIN_GRID_DISTANCE = 70.0
"""The minimum distance of two grid lines in the drawing."""
_PADDING = 0.05
"""The free space on each side, as a fraction of the longer side of the box around the paths."""
_NOTE_WIDTH = 70.0
"""The space for the text of a distance in the drawing."""
_MIN_SPAN_M = 0.02
"""The minimum length in m of the longer side of the box around the paths."""


@dataclass(frozen=True)
class _Frame:
    """The mapping from positions in m to the drawing.

    In the drawing, x points to the right and y up, with the same scale.

    Attributes:
        low: the position of the lower left corner, in m.
        scale: the length of a meter in the drawing.
        height: the height of the area with the paths.
    """

    low: tuple[float, float]
    scale: float
    height: float

    @classmethod
    def around(cls, comparison: PathComparison) -> _Frame:
        """Return the frame that contains all shown paths."""
        points = [point for pair in comparison.shown for path in (pair.old, pair.new) for point in path]
        low = [min(point[axis] for point in points) for axis in (1, 2)]
        high = [max(point[axis] for point in points) for axis in (1, 2)]
        margin = max(high[0] - low[0], high[1] - low[1], _MIN_SPAN_M) * _PADDING
        spans = [high[axis] - low[axis] + 2.0 * margin for axis in (0, 1)]
        width = _WIDTH - _LEFT_MARGIN - _RIGHT_MARGIN
        scale = min(width / spans[0], _MAX_HEIGHT / spans[1])
        height = max(spans[1] * scale, _MIN_HEIGHT)
        centers = [(low[axis] + high[axis]) / 2.0 for axis in (0, 1)]
        return cls((centers[0] - width / scale / 2.0, centers[1] - height / scale / 2.0), scale, height)

    def x(self, position: float) -> float:
        """Return the coordinate in the drawing of a position on the x axis."""
        return _LEFT_MARGIN + (position - self.low[0]) * self.scale

    def y(self, position: float) -> float:
        """Return the coordinate in the drawing of a position on the y axis."""
        return _TOP_MARGIN + self.height - (position - self.low[1]) * self.scale

    def ticks(self, axis: int) -> Iterator[tuple[float, str]]:
        """Yield the positions and labels of the grid lines, at round numbers of meters."""
        length = (self.height if axis else _WIDTH - _LEFT_MARGIN - _RIGHT_MARGIN) / self.scale
        step = _choose_round_step(_MIN_GRID_DISTANCE / self.scale)
        digits = max(0, -floor(log10(step) + 1e-9))
        for number in range(ceil(self.low[axis] / step), floor((self.low[axis] + length) / step) + 1):
            yield number * step, f"{number * step + 0.0:.{digits}f}"


def draw_path_plot(comparison: PathComparison) -> str:
    """Return a figure with thin lines for all shown paths and thick lines for the typical pair."""
    frame = _Frame.around(comparison)
    typical = comparison.typical
    content = "".join(
        (
            *_draw_grid(frame),
            *(_draw_path(frame, pair.old, "old thin", pair.seed) for pair in comparison.shown),
            *(_draw_path(frame, pair.new, "new thin", pair.seed) for pair in comparison.shown),
            _draw_path(frame, typical.old, "old thick", typical.seed),
            _draw_path(frame, typical.new, "new thick", typical.seed),
            *_draw_end_marks(frame, typical),
            _draw_distance(frame, comparison.farthest),
        )
    )
    title = comparison.title
    label = phrase("paths of both versions, {name}", name=title)
    height = _TOP_MARGIN + frame.height + _BOTTOM_MARGIN
    return (
        f"<figure class='plot'><figcaption><strong>{escape(title)}</strong>{_draw_legend(comparison)}</figcaption>"
        f"<svg viewBox='0 0 {_WIDTH:g} {height:.0f}' role='img' aria-label='{_escape(label)}'>{content}</svg></figure>"
    )


def _draw_grid(frame: _Frame) -> Iterator[str]:
    bottom, right = _TOP_MARGIN + frame.height, _WIDTH - _RIGHT_MARGIN
    for position, text in frame.ticks(0):
        x = frame.x(position)
        yield f"<line class='grid' x1='{x:.1f}' x2='{x:.1f}' y1='{_TOP_MARGIN:g}' y2='{bottom:.1f}'/>"
        yield f"<text class='tick' x='{x:.1f}' y='{bottom + 15:.1f}' text-anchor='middle'>{text}</text>"
    for position, text in frame.ticks(1):
        y = frame.y(position)
        yield f"<line class='grid' x1='{_LEFT_MARGIN:g}' x2='{right:g}' y1='{y:.1f}' y2='{y:.1f}'/>"
        yield f"<text class='tick' x='{_LEFT_MARGIN - 7:g}' y='{y + 4:.1f}' text-anchor='end'>{text}</text>"
    center = (_LEFT_MARGIN + right) / 2.0
    yield f"<text class='tick' x='{center:.1f}' y='{bottom + 32:.1f}' text-anchor='middle'>x [m]</text>"
    middle = _TOP_MARGIN + frame.height / 2.0
    yield f"<text class='tick' transform='translate(12 {middle:.1f}) rotate(-90)' text-anchor='middle'>y [m]</text>"


def _draw_path(frame: _Frame, path: Points, kind: str, seed: str) -> str:
    points = " ".join(f"{frame.x(x):.1f},{frame.y(y):.1f}" for _, x, y in path)
    name = _escape(phrase("seed {seed}", seed=seed))
    return f"<polyline class='path {kind}' points='{points}'><title>{name}</title></polyline>"


def _draw_end_marks(frame: _Frame, pair: PathPair) -> Iterator[str]:
    """Yield the marks at the start and at the end of both paths."""
    for kind, path in (("old", pair.old), ("new", pair.new)):
        _, x, y = path[-1]
        yield f"<circle class='end {kind}' cx='{frame.x(x):.1f}' cy='{frame.y(y):.1f}' r='5'/>"
    for x, y in dict.fromkeys((path[0][1], path[0][2]) for path in (pair.old, pair.new)):
        left, top = frame.x(x) - 5.0, frame.y(y) - 5.0
        yield f"<rect class='start' x='{left:.1f}' y='{top:.1f}' width='10' height='10'/>"


def _draw_distance(frame: _Frame, pair: PathPair) -> str:
    """Return the line between both robots at their largest distance, with the distance."""
    (x1, y1), (x2, y2) = ((frame.x(x), frame.y(y)) for x, y in pair.ends)
    x, y = (x1 + x2) / 2.0, (y1 + y2) / 2.0
    is_left = x < _WIDTH - _RIGHT_MARGIN - _NOTE_WIDTH
    return (
        f"<line class='apart' x1='{x1:.1f}' y1='{y1:.1f}' x2='{x2:.1f}' y2='{y2:.1f}'/>"
        f"<text class='note' x='{x + (9 if is_left else -9):.1f}' y='{y - 5:.1f}' "
        f"text-anchor='{'start' if is_left else 'end'}'>{pair.distance:.3g} m</text>"
    )


def _draw_legend(comparison: PathComparison) -> str:
    farthest, count = comparison.farthest, len(comparison.pairs)
    apart = phrase("farthest apart: seed {seed}, after {time:.3g} s", seed=farthest.seed, time=farthest.time)
    entries: list[tuple[str, Phrase]] = [
        ("<line class='old thick' x1='2' x2='24' y1='6' y2='6'/>", phrase("before")),
        ("<line class='new thick' x1='2' x2='24' y1='6' y2='6'/>", phrase("after")),
        ("<rect class='start' x='8' y='1' width='10' height='10'/>", phrase("start")),
        ("<line class='apart' x1='2' x2='24' y1='6' y2='6'/>", apart),
    ]
    if count > 1:
        text = phrase("thick: seed {seed}, the median of {count} runs", seed=comparison.typical.seed, count=count)
        entries.insert(2, ("", text))
    return f"<span class='legend'>{''.join(_draw_legend_entry(*entry) for entry in entries)}</span>"


def _draw_legend_entry(mark: str, text: Phrase) -> str:
    drawing = f"<svg viewBox='0 0 26 12' aria-hidden='true'>{mark}</svg>" if mark else ""
    return f"<span>{drawing}{_escape(text)}</span>"


def _choose_round_step(minimum: float) -> float:
    """Return the smallest round number that is not less than a minimum.

    Round numbers are 1, 2 and 5, times a power of ten.
    """
    power = 10.0 ** floor(log10(minimum))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= minimum * (1.0 - 1e-9))


def _escape(text: Phrase) -> str:
    return escape(localized(text))
