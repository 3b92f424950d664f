"""Reports of the tf buffer's frames in tf2's formats: text, YAML and Graphviz."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from linkwright.graph.transforms.cache import format_time
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_MIN_SPAN_NS = 100_000
"""The minimum span from which a rate is computed, so that the rate is finite (tf2: 100 microseconds)."""


@dataclass(frozen=True, slots=True)
class FrameFacts:
    """The data of one frame in the reports.

    Attributes:
        name: the name of the frame.
        parent: the name of the frame's parent.
        authority: the sender of the latest transform.
        count: the number of transforms of the frame that are stored.
        latest_ns: the stamp of the latest transform, in nanoseconds; 0 for a static transform.
        oldest_ns: the stamp of the oldest transform, in nanoseconds.
    """

    name: str
    parent: str
    authority: str
    count: int
    latest_ns: int
    oldest_ns: int

    @property
    def rate(self) -> float:
        """The number of transforms per second, in Hz."""
        span_ns = max(self.latest_ns - self.oldest_ns, _MIN_SPAN_NS)
        return self.count * 1e9 / span_ns

    @property
    def length_s(self) -> float:
        """The time between the oldest and the latest transform, in seconds."""
        return (self.latest_ns - self.oldest_ns) / NANOSECONDS_PER_SECOND


def frames_as_text(frames: Sequence[FrameFacts]) -> str:
    """Return a text that names each frame and its parent, one frame per line."""
    return "".join(f"Frame {frame.name} exists with parent {frame.parent}.\n" for frame in frames)


def frames_as_yaml(frames: Sequence[FrameFacts], now_ns: int) -> str:
    """Return the frames as a YAML mapping.

    Delays relative to `now_ns` are included unless it is 0.
    """
    if not frames:
        return "[]"
    lines = []
    for frame in frames:
        lines += [
            f"{frame.name}: ",
            f"  parent: '{frame.parent}'",
            f"  broadcaster: '{frame.authority}'",
            f"  rate: {frame.rate:.3f}",
            f"  most_recent_transform: {format_time(frame.latest_ns)}",
            f"  oldest_transform: {format_time(frame.oldest_ns)}",
        ]
        if now_ns:
            lines.append(f"  transform_delay: {(now_ns - frame.latest_ns) / NANOSECONDS_PER_SECOND:.3f}")
        lines.append(f"  buffer_length: {frame.length_s:.3f}")
    return "\n".join(lines) + "\n"


def frames_as_dot(frames: Sequence[FrameFacts], now_ns: int) -> str:
    """Return the frames as a Graphviz graph.

    Ages relative to `now_ns` are included unless it is 0.
    """
    lines = ["digraph G {"]
    if not frames:
        lines.append('"no tf data recieved"')  # the spelling is tf2's
    for frame in frames:
        age = f"( {(now_ns - frame.latest_ns) / NANOSECONDS_PER_SECOND:.3f} sec old)" if now_ns else ""
        lines.append(
            f'"{frame.parent}" -> "{frame.name}"[label="Broadcaster: {frame.authority}\\n'
            f"Average rate: {frame.rate:.3f} Hz\\nMost recent transform: {format_time(frame.latest_ns)} {age}\\n"
            f'Buffer length: {frame.length_s:.3f} sec\\n"];'
        )
    lines.append("edge [style=invis];")
    if now_ns:
        lines += [
            ' subgraph cluster_legend { style=bold; color=black; label ="view_frames Result";',
            f'"Recorded at time: {format_time(now_ns)}"[ shape=plaintext ] ;',
            " }",
        ]
        names = {frame.name for frame in frames}
        roots = dict.fromkeys(frame.parent for frame in frames if frame.parent not in names)
        lines += [f'"Recorded at time: {format_time(now_ns)}"->"{root}";' for root in roots]
    return "\n".join(lines) + "\n}\n"
