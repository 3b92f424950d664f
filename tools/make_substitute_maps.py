"""Write the maps of the worlds that stand in for those of nav2_bringup.

Usage: python tools/make_substitute_maps.py

A cell is solid if its center is in a collision at the height of the laser. Cells that the robot reaches from its start
are free, solid cells next to them are occupied, and the others are unknown.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from linkwright.navigation.grids.grid import FREE, OCCUPIED, UNKNOWN, Grid
from linkwright.navigation.maps.map_files import MapSaveSettings, save_map
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.simulation import Simulation
from linkwright.testing.scenes import read_world

SHARE_FOLDER = Path(__file__).resolve().parent.parent / "src/linkwright/navigation/substitutes/share/nav2_bringup"
WORLD_FILE = SHARE_FOLDER / "worlds" / "world_only.model"
MAP_NAMES = ("turtlebot3_world", "tb3_sandbox")
"""The names of the map in nav2_bringup of Humble, and from Jazzy on."""
LASER_HEIGHT_M = 0.18
START_M = (-2.0, -0.5)
"""The position at which nav2_bringup's launch files spawn the robot."""
SIZE_CELLS, RESOLUTION_M, ORIGIN_M = 160, 0.05, -4.0
WALL_CELLS = 2
"""The thickness at which walls are drawn, in cells."""


def make_map() -> Grid:
    """Return the map of the world, in the frame of the world."""
    loaded = read_world(str(WORLD_FILE))
    grid = Grid(
        cells=np.full((SIZE_CELLS, SIZE_CELLS), UNKNOWN, np.int8), resolution=RESOLUTION_M, x=ORIGIN_M, y=ORIGIN_M
    )
    is_solid = _find_solid_cells(Simulation(loaded.world, loaded.finder), grid)
    is_free = np.zeros_like(is_solid)
    is_free[tuple(grid.cells_of(np.array(START_M)))] = True
    while True:
        reached = _grow(is_free) & ~is_solid
        if (reached == is_free).all():
            break
        is_free = reached
    near = is_free
    for _ in range(WALL_CELLS):
        near = _grow(near)
    grid.cells[is_solid & near] = OCCUPIED
    grid.cells[is_free] = FREE
    return grid


def _find_solid_cells(simulation: Simulation, grid: Grid) -> np.ndarray:
    """Return which centers of cells are in a box or a cylinder at the height of the laser."""
    simulation.refresh()
    model, data, types = simulation.model, simulation.data, load_mujoco().mjtGeom
    rows, columns = np.indices(grid.cells.shape)
    centers = grid.centers_of(np.stack((rows, columns), axis=-1))
    points = np.concatenate((centers, np.full((*centers.shape[:2], 1), LASER_HEIGHT_M)), axis=-1)
    is_solid = np.zeros(grid.cells.shape, dtype=bool)
    for geom in np.flatnonzero(model.geom_contype):
        local = np.abs((points - data.geom_xpos[geom]) @ data.geom_xmat[geom].reshape(3, 3))
        size = model.geom_size[geom]
        if model.geom_type[geom] == types.mjGEOM_BOX:
            is_solid |= (local <= size).all(axis=-1)
        elif model.geom_type[geom] == types.mjGEOM_CYLINDER:
            is_solid |= (np.hypot(local[..., 0], local[..., 1]) <= size[0]) & (local[..., 2] <= size[1])
    return is_solid


def _grow(cells: np.ndarray) -> np.ndarray:
    """Return the marked cells and their neighbors in four directions."""
    grown = cells.copy()
    grown[1:] |= cells[:-1]
    grown[:-1] |= cells[1:]
    grown[:, 1:] |= cells[:, :-1]
    grown[:, :-1] |= cells[:, 1:]
    return grown


if __name__ == "__main__":
    for name in MAP_NAMES:
        save_map(make_map(), MapSaveSettings(name=str(SHARE_FOLDER / "maps" / name), free_thresh=0.196))
