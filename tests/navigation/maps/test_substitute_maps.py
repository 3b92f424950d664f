"""The world and the maps that stand in for those of nav2_bringup."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest

from linkwright.navigation.grids.grid import FREE, OCCUPIED
from linkwright.navigation.maps.map_files import load_map
from linkwright.packages import PackageFinder

TOOL = Path(__file__).resolve().parents[3] / "tools" / "make_substitute_maps.py"


def share_folder() -> Path:
    # Without sources: a checkout of nav2 near the start folder would take precedence.
    return PackageFinder(start=Path("/no/such/folder"), environment={}).share("nav2_bringup")


@pytest.mark.parametrize("name", ["turtlebot3_world", "tb3_sandbox"])
def test_map_shows_the_world(name):
    grid = load_map(share_folder() / "maps" / f"{name}.yaml")
    made = runpy.run_path(str(TOOL))["make_map"]()
    assert (grid.cells == made.cells).all()
    assert (grid.resolution, grid.x, grid.y, grid.yaw) == (made.resolution, made.x, made.y, made.yaw)


def test_robot_starts_in_free_space_among_nine_pillars():
    grid = load_map(share_folder() / "maps" / "turtlebot3_world.yaml")
    assert grid.cells[tuple(grid.cells_of(np.array((-2.0, -0.5))))] == FREE
    for x in (-1.1, 0.0, 1.1):
        for y in (-1.1, 0.0, 1.1):
            assert grid.cells[tuple(grid.cells_of(np.array((x, y + 0.13))))] == OCCUPIED
    assert grid.cells[tuple(grid.cells_of(np.array((-1.65, -1.2))))] == FREE
