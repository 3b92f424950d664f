"""rviz_default_plugins/GridCells."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from linkwright.viewer.config.schema import PropertySpec, topic_spec
from linkwright.viewer.displays.base.data_display import Pose
from linkwright.viewer.displays.base.topic_display import TOPIC, TopicDisplay
from linkwright.viewer.displays.properties.look import alpha
from linkwright.viewer.protocol.parts import StatusLevel
from linkwright.viewer.protocol.points import CellGrid


class GridCellsDisplay(TopicDisplay):
    """Flat cells of one size."""

    CLASS = "rviz_default_plugins/GridCells"
    MESSAGE = "nav_msgs/msg/GridCells"
    SCHEMA = (
        topic_spec(description=MESSAGE, filter_size=10),
        PropertySpec("Color", "color", "#19ff00", "Colour of the cells."),
        alpha("Opacity of the cells: 0 is invisible."),
    )

    def take(self, message: Any, pose: Pose | None) -> None:
        """Show the cells."""
        cells = [each for cell in message.cells for each in (cell.x, cell.y, cell.z)]
        positions = np.array(cells, dtype=np.float64).reshape(-1, 3)
        sides = (message.cell_width, message.cell_height)
        if not (np.isfinite(positions).all() and all(map(math.isfinite, sides))):
            self._refuse("error", "Message contained invalid floating point values (nans or infs)")
        elif 0.0 in sides:
            self._refuse("error", "One of the Cell's dimension is zero, cells will be invisible.")
        elif not cells:
            self._refuse("warn", "Message is empty: there are no cells to be shown.")
        else:
            content = CellGrid(positions.astype(np.float32), float(sides[0]), float(sides[1]))
            self.send(content, pose=pose, stamp_ns=self.frame_of(message)[1])

    def _refuse(self, level: StatusLevel, text: str) -> None:
        """RViz takes the cells before away too, and says so in the row of the topic."""
        self.forget()
        self.say(TOPIC, level, text)
