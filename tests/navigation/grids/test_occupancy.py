"""Occupancy grids from messages and back."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.messages import Time
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.occupancy import BadGridError, grid_from_message, occupancy_message


def test_grid_message_round_trip() -> None:
    grid = Grid(cells=np.array([[0, 100, -1], [5, 6, 7]], np.int8), resolution=0.05, x=-1.0, y=2.0, yaw=pi / 2)
    message = occupancy_message(grid, "map", Time(sec=3))
    assert (message.info.width, message.info.height) == (3, 2)
    assert list(message.data) == [0, 100, -1, 5, 6, 7]
    assert (message.header.frame_id, message.header.stamp.sec, message.info.map_load_time.sec) == ("map", 3, 3)
    converted = grid_from_message(message)
    assert (converted.cells == grid.cells).all()
    assert converted.cells.dtype == np.int8
    assert (converted.x, converted.y) == (-1.0, 2.0)
    assert abs(converted.yaw - pi / 2) < 1e-12
    assert converted.resolution == 0.05


@pytest.mark.parametrize(
    ("change", "text"), [("width", "width = 4, height = 2, data size = 6"), ("size", "resolution = 0")]
)
def test_malformed_grid_message_is_rejected(change: str, text: str) -> None:
    message = occupancy_message(Grid(cells=np.zeros((2, 3), np.int8), resolution=0.05), "map", Time())
    if change == "width":
        message.info.width = 4
    else:
        message.info.resolution = 0.0
    with pytest.raises(BadGridError, match=text):
        grid_from_message(message)
