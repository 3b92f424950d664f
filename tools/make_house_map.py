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
from linkwright.navigation.grids.ray_counts import ray_counts
from linkwright.navigation.maps.map_files import MapSaveSettings, save_map
from linkwright.packages import PackageFinder
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.worlds import World
from linkwright.simulation.ray_casting import GROUP_COUNT, cast_rays
from linkwright.simulation.simulation import Simulation
from linkwright.testing.scenes import read_world

PACKAGE = Path(__file__).resolve().parent.parent / "robots" / "my_robot_gazebo"
HEIGHT = 0.215
"""The height of the laser of mbot_gazebo.xacro above the ground, in meters."""
RAYS = 2880
REACH = 20.0
APART = 10
"""The number of cells between two positions of the laser."""
WALLS = "walls"
"""The model of the walls."""
INSIDE = np.array((4.9, 3.9))
"""The distance from the origin to the outer walls along x and y, in meters. The front door is open."""


def house_map() -> Grid:
    """Return the map, with cells of 5 cm in the frame of the world."""
    world = read_world(str(PACKAGE / "worlds" / "house.world")).world
    grid = _seen(world)
    bare = _seen(replace(world, models=tuple(model for model in world.models if model.name == WALLS)))
    grid.cells[(grid.cells == UNKNOWN) & (bare.cells == OCCUPIED)] = OCCUPIED
    return grid


def _seen(world: World) -> Grid:
    """Return the map of a world that the laser creates."""
    simulation = Simulation(world, ResourceFinder(PackageFinder(start=[PACKAGE])))
    grid = Grid(cells=np.full((180, 220), UNKNOWN, np.int8), resolution=0.05, x=-5.5, y=-4.5)
    shape = (grid.rows, grid.columns)
    hits, passes = np.zeros(shape, np.int64), np.zeros(shape, np.int64)
    angles = np.linspace(-np.pi, np.pi, RAYS, endpoint=False)
    rays = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(RAYS)))
    groups = np.ones(GROUP_COUNT, np.uint8)
    waiting, seen = [grid.cells_of(np.zeros(2))], set()
    while waiting:
        cell = waiting.pop()
        if tuple(cell) in seen:
            continue
        seen.add(tuple(cell))
        place = grid.centers_of(cell)
        origin = np.array((*place, HEIGHT))
        distances, _ = cast_rays(simulation.model, simulation.data, origin, rays, groups, excluded_body=-1, max_distance=REACH)
        met = distances > 0.0
        # Slightly inside the object, so that a wall on the border of two cells belongs to one of them.
        ends = place + (np.where(met, distances + 0.002, REACH))[:, None] * rays[:, :2]
        hit, passed = ray_counts(shape, cell, grid.cells_of(ends), met)
        hits += hit
        passes += passed
        for way in ((APART, 0), (-APART, 0), (0, APART), (0, -APART)):
            beside = cell + way
            between = np.linspace(cell, beside, APART + 1).astype(int)
            inside = (np.abs(grid.centers_of(beside)) < INSIDE).all()
            if inside and not hits[tuple(between.T)].any() and passes[tuple(between.T)].all():
                waiting.append(beside)
    # A ray that grazes a wall also crosses its cells: cells that are usually hit are occupied.
    grid.cells[passes > 0] = FREE
    grid.cells[hits > 0.1 * passes] = OCCUPIED
    return grid


if __name__ == "__main__":
    save_map(house_map(), MapSaveSettings(name=str(PACKAGE / "maps" / "house"), free_thresh=0.196))
