"""Convert received nav2_msgs/Costmap messages to costmaps."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.navigation.costmaps.costmap import Costmap
from linkwright.navigation.grids.grid import Grid


def costmap_from_message(message: Any) -> Costmap:
    """Convert a nav2_msgs/Costmap to a costmap."""
    metadata = message.metadata
    cells = np.frombuffer(message.data, np.uint8).reshape(metadata.size_y, metadata.size_x)
    origin = metadata.origin.position
    return Costmap(Grid(cells=cells, resolution=metadata.resolution, x=origin.x, y=origin.y))
