"""The frames at one moment, as displays see them."""

from __future__ import annotations

from dataclasses import dataclass, field

from linkwright.viewer.config.schema import FIXED_FRAME
from linkwright.viewer.protocol.parts import StatusRow


@dataclass(frozen=True, slots=True)
class FrameView:
    """Which frames there are, how they hang together and which of them can be placed in the Fixed Frame.

    Attributes:
        fixed_frame: the Fixed Frame, which may be unknown to tf.
        names: the frames tf knows.
        parents: index of each frame's parent in `names`, -1 for a root.
        placed: the frames with a transform to the Fixed Frame; this one always is, as in RViz.
    """

    fixed_frame: str = ""
    names: tuple[str, ...] = ()
    parents: tuple[int, ...] = ()
    placed: frozenset[str] = field(default_factory=frozenset)

    def problem(self, frame: str) -> str | None:
        """RViz's words for a frame that cannot be placed, or None."""
        if frame in self.placed:
            return None
        return f"No transform from [{frame}] to [{self.fixed_frame}]"


def transform_status(frames: FrameView, frame: str) -> StatusRow:
    """The Transform row of a display in a frame (or in ``<Fixed Frame>``), in RViz's words."""
    if frame == FIXED_FRAME or frame in frames.placed:
        return StatusRow("Transform", "ok", "Transform OK")
    return StatusRow("Transform", "error", f"Could not transform from [{frame}] to [{frames.fixed_frame}]")
