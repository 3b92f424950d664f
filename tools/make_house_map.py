"""Write the map of the house, ``robots/my_robot_gazebo/maps/house.yaml`` and its image.

Usage: python tools/make_house_map.py

An exact laser at the height of mbot's laser scans the house from many positions that can be reached from the origin.
Cells along its rays are free, and cells at their ends are occupied, as with a mapper that makes no errors. Walls behind
furniture are drawn as if there were no furniture. Otherwise, planners that cross unknown cells, as nav2's do, would
lead out of the front door, around the house and through the back of a wardrobe.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from linkwright.navigation.grids.grid import FREE, OCCUPIED, UNKNOWN, Grid
from linkwright.navigation.grids.ray_counts import count_rays
from linkwright.navigation.maps.map_files import MapSaveSettings, save_map
from linkwright.packages import PackageFinder
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.worlds import World
from linkwright.simulation.ray_casting import GROUP_COUNT, cast_rays
from linkwright.simulation.simulation import Simulation
from linkwright.testing.scenes import read_world

PACKAGE = Path(__file__).resolve().parent.parent / "robots" / "my_robot_gazebo"
LASER_HEIGHT_M = 0.215
"""The height of the laser of mbot_gazebo.xacro above the ground, in meters."""
RAY_COUNT = 2880
LASER_RANGE_M = 20.0
SCAN_SPACING_CELLS = 10
"""The number of cells between two positions of the laser."""
WALLS_MODEL = "walls"
"""The model of the walls."""
HALF_SIZE_M = np.array((4.9, 3.9))
"""The distance from the origin to the outer walls along x and y, in meters. The front door is open."""


def make_house_map() -> Grid:
    """Return the map, with cells of 5 cm in the frame of the world."""
    world = read_world(str(PACKAGE / "worlds" / "house.world")).world
    grid = _scan_world(world)
    walls_grid = _scan_world(replace(world, models=tuple(model for model in world.models if model.name == WALLS_MODEL)))
    grid.cells[(grid.cells == UNKNOWN) & (walls_grid.cells == OCCUPIED)] = OCCUPIED
    return grid


def _scan_world(world: World) -> Grid:
    """Return the map of a world that the laser creates."""
    simulation = Simulation(world, ResourceFinder(PackageFinder(start=[PACKAGE])))
    grid = Grid(cells=np.full((180, 220), UNKNOWN, np.int8), resolution=0.05, x=-5.5, y=-4.5)
    shape = (grid.rows, grid.columns)
    hits, passes = np.zeros(shape, np.int64), np.zeros(shape, np.int64)
    angles = np.linspace(-np.pi, np.pi, RAY_COUNT, endpoint=False)
    rays = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(RAY_COUNT)))
    groups = np.ones(GROUP_COUNT, np.uint8)
    pending_cells, scanned_cells = [grid.cells_of(np.zeros(2))], set()
    while pending_cells:
        cell = pending_cells.pop()
        if tuple(cell) in scanned_cells:
            continue
        scanned_cells.add(tuple(cell))
        position = grid.centers_of(cell)
        origin = np.array((*position, LASER_HEIGHT_M))
        distances, _ = cast_rays(
            simulation.model, simulation.data, origin, rays, groups, excluded_body=-1, max_distance=LASER_RANGE_M
        )
        is_hit = distances > 0.0
        # Slightly inside the object, so that a wall on the border of two cells belongs to one of them.
        ends = position + (np.where(is_hit, distances + 0.002, LASER_RANGE_M))[:, None] * rays[:, :2]
        hit, passed = count_rays(shape, cell, grid.cells_of(ends), is_hit)
        hits += hit
        passes += passed
        for offset in (
            (SCAN_SPACING_CELLS, 0),
            (-SCAN_SPACING_CELLS, 0),
            (0, SCAN_SPACING_CELLS),
            (0, -SCAN_SPACING_CELLS),
        ):
            next_cell = cell + offset
            cells_between = np.linspace(cell, next_cell, SCAN_SPACING_CELLS + 1).astype(int)
            is_inside = (np.abs(grid.centers_of(next_cell)) < HALF_SIZE_M).all()
            if is_inside and not hits[tuple(cells_between.T)].any() and passes[tuple(cells_between.T)].all():
                pending_cells.append(next_cell)
    # A ray that grazes a wall also crosses its cells: cells that are usually hit are occupied.
    grid.cells[passes > 0] = FREE
    grid.cells[hits > 0.1 * passes] = OCCUPIED
    return grid


if __name__ == "__main__":
    save_map(make_house_map(), MapSaveSettings(name=str(PACKAGE / "maps" / "house"), free_thresh=0.196))
