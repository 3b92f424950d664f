"""A base class for displays of markers that depend on the pose of the message's frame."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.geometry.single import IDENTITY
from linkwright.rviz.displays.base.display import Pose
from linkwright.rviz.displays.marker import MessageMarkersDisplay


class PlacedMarkersDisplay(MessageMarkersDisplay):
    """A base class for displays whose markers are in the Fixed Frame.

    A message waits until its frame can be placed. The `SCHEMA` of a subclass has a `topic_spec` with a filter size.

    Attributes:
        frame_pose: the pose that the message's frame had in the Fixed Frame; `markers` reads it.
    """

    TRANSFORMED = True
    frame_pose: Pose = np.array(IDENTITY)

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Draw a message at the pose that its frame had."""
        assert pose is not None
        self.frame_pose = pose
        super().process_message(message, pose)

    def on_transforms_received(self) -> None:
        """Draw the queued messages that can be placed now."""
        self._show_placeable()
        super().on_transforms_received()

    def on_frames_changed(self) -> None:
        """Draw the last message in the new Fixed Frame."""
        if self._check_fixed_frame_change():
            self._waiting.clear()
            self.reset()
            self.show_again()
        self._show_placeable()
