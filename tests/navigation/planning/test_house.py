"""The map of the house.

Plans that may cross unknown cells stay within its walls, and avoid its furniture.
"""

from __future__ import annotations

import numpy as np

from linkwright.navigation.costmaps.costmap import INSCRIBED, UNKNOWN
from linkwright.navigation.costmaps.inflation_layer import Inflation
from linkwright.navigation.grids.distances import distance_field
from linkwright.navigation.grids.grid import FREE, OCCUPIED, Grid
from linkwright.navigation.grids.grid import UNKNOWN as UNSEEN
from linkwright.navigation.maps.map_files import load_map
from linkwright.navigation.planning.planner import run_to_end
from linkwright.navigation.planning.potential import compute_crossing_prices, compute_potential
from tests.places import GAZEBO_PACKAGE

ROBOT_RADIUS_M = 0.22
OUTER_WALLS = np.array((4.9, 3.9))
"""The distances in meters from the origin to the inner sides of the outer walls, along x and y."""
ROOM_POINTS = {
    "living room": (0.0, 0.0),
    "bedroom": (-1.9, 1.6),
    "hall": (0.0, 2.5),
    "bath": (2.4, 2.4),
    "kitchen": (2.3, -1.7),
}
DOORS = [(-1.5, 1.05), (0.9, 2.5), (1.55, -1.6)]
"""The doors of bedroom, bath and kitchen."""


def load_house() -> Grid:
    return load_map(GAZEBO_PACKAGE / "maps" / "house.yaml")


def reachable_cells(grid: Grid) -> np.ndarray:
    """Return the cells that a planner reaches from the living room; unknown cells are allowed."""
    distances = distance_field(grid.cells == OCCUPIED, grid.resolution)
    costs = Inflation(inflation_radius=0.6, cost_scaling_factor=3.0).compute_costs(distances, ROBOT_RADIUS_M)
    costs = np.where(distances > 0.6, 0, costs).astype(np.uint8)
    costs[(grid.cells == UNSEEN) & (costs < INSCRIBED)] = UNKNOWN
    row, column = grid.cells_of(np.array(ROOM_POINTS["living room"]))
    return np.isfinite(run_to_end(compute_potential(compute_crossing_prices(costs), (int(row), int(column)))))


def free_or_outside(grid: Grid) -> np.ndarray:
    """Return the cells that are free or outside the house."""
    centers = grid.centers_of(np.moveaxis(np.indices(grid.cells.shape), 0, -1))
    return (grid.cells == FREE) | (np.abs(centers) > OUTER_WALLS).any(axis=-1)


def test_planner_reaches_all_rooms_and_no_unseen_cells():
    grid = load_house()
    reachable = reachable_cells(grid)
    assert all(reachable[tuple(grid.cells_of(np.array(point)))] for point in ROOM_POINTS.values())
    assert free_or_outside(grid)[reachable].all()


def test_closed_doors_separate_rooms():
    grid = load_house()
    for door in DOORS:
        row, column = grid.cells_of(np.array(door))
        grid.cells[row - 8 : row + 9, column - 8 : column + 9] = OCCUPIED
    reachable = reachable_cells(grid)
    unreachable_rooms = [
        name for name, point in ROOM_POINTS.items() if not reachable[tuple(grid.cells_of(np.array(point)))]
    ]
    assert unreachable_rooms == ["bedroom", "bath", "kitchen"]
    assert free_or_outside(grid)[reachable].all()
