"""Measure costmaps and plans: the processor time of an update and a plan, in a house and a large hall.

Run it with ``python -m benchmarks navigation``. The maps are 25 rooms with doors, of cells of 5 cm; plans lead from one
corner to the opposite one, and to the middle. It is the time of the processor that counts, and the best of some turns.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from benchmarks.measure import Row, show
from linkwright.navigation.costmaps.costmap import Costmap
from linkwright.navigation.costmaps.footprints import circle
from linkwright.navigation.costmaps.inflation_layer import Inflation, InflationLayer
from linkwright.navigation.costmaps.layered import LayeredCostmap
from linkwright.navigation.costmaps.observations import ObservationBuffer, Source
from linkwright.navigation.costmaps.obstacle_layer import HeightRange, ObstacleLayer
from linkwright.navigation.costmaps.static_layer import Interpretation, StaticLayer
from linkwright.navigation.costmaps.voxel_layer import VoxelLayer, Voxels
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.planning.planner import Settings, plan, run_to_end
from linkwright.navigation.planning.smoothing import Smoothing, smooth_path

_RESOLUTION = 0.05
_ROOMS = 5
_WALL, _DOOR, _CORNER = 3, 20, 8
_TURNS = 5
_RAYS = 360
_RADIUS = 0.2
_HERE = (5.0, 5.0, 0.0)
_INFLATION = Inflation(cost_scaling_factor=3.0)


def rooms(size: int) -> NDArray[np.int8]:
    """Return an occupancy grid of rooms with doors, shape (size, size)."""
    rng = np.random.default_rng(1)
    cells = np.zeros((size, size), np.int8)
    cells[[0, -1]] = 100
    cells[:, [0, -1]] = 100
    room = size // _ROOMS
    walls = [wall * room for wall in range(1, _ROOMS)]
    for wall in walls:
        cells[wall : wall + _WALL] = 100
        cells[:, wall : wall + _WALL] = 100
    for wall in walls:
        for beside in range(_ROOMS):
            for part in (cells, cells.T):
                door = beside * room + int(rng.integers(_CORNER, room - _DOOR - _CORNER))
                part[wall : wall + _WALL, door : door + _DOOR] = 0
    return cells


def milliseconds(work: Callable[..., object], *arguments: object, turns: int = _TURNS) -> float:
    """Return the processor time of a call in ms, the minimum of several turns."""
    best = float("inf")
    for _ in range(turns):
        begin = time.thread_time()
        work(*arguments)
        best = min(best, time.thread_time() - begin)
    return 1000.0 * best


def scan(x: float, y: float) -> NDArray[np.float64]:
    """Return points around a position, shape (rays, 3)."""
    angles = np.linspace(0.0, 2.0 * np.pi, _RAYS, endpoint=False)
    return np.stack((x + 2.3 * np.cos(angles), y + 2.3 * np.sin(angles), np.full(_RAYS, 0.2)), axis=-1)


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    return [*_in_rooms(400, "50 ms"), *_in_rooms(2000, "2000 ms"), _local()]


def _in_rooms(size: int, promised: str) -> list[Row]:
    """Measure a fixed costmap with a map, and plans from corner to corner and to the middle."""
    what = f"{size} x {size} cells"
    buffer = ObservationBuffer(Source(clearing=True, max_obstacle_height=2.0))
    static = StaticLayer(Interpretation())
    layers = [static, ObstacleLayer([buffer], HeightRange()), InflationLayer(_INFLATION)]
    layered = LayeredCostmap(_blank(size), layers, circle(_RADIUS))
    static.set_map(Grid(cells=rooms(size), resolution=_RESOLUTION))
    table = [Row(f"costmap of {what}, all of it", milliseconds(_anew, layered), "ms")]
    costmap = layered.costmap.copy()
    table.append(Row(f"costmap of {what}, a scan", milliseconds(_seen, layered, buffer), "ms"))
    end, middle = (size - 25) * _RESOLUTION, (size / 2 + 30) * _RESOLUTION
    taken = milliseconds(_path, costmap, end, turns=3)
    table.append(Row(f"plan over {what}, corner to corner", taken, "ms", promised))
    table.append(Row(f"plan over {what}, to the middle", milliseconds(_path, costmap, middle, turns=3), "ms"))
    path = _path(costmap, end)
    taken = milliseconds(smooth_path, path[:, :2], Smoothing(), costmap)
    table.append(Row(f"smoothing {len(path)} poses", taken, "ms"))
    return table


def _local() -> Row:
    """Measure a costmap that moves with the robot."""
    buffer = ObservationBuffer(Source(clearing=True, max_obstacle_height=2.0))
    layers = [VoxelLayer([buffer], HeightRange(), Voxels(z_voxels=16, z_resolution=0.05)), InflationLayer(_INFLATION)]
    local = LayeredCostmap(_blank(60), layers, circle(_RADIUS), is_rolling=True)
    return Row("local costmap of 60 x 60 cells with voxels, a scan", milliseconds(_seen, local, buffer), "ms")


def _blank(size: int) -> Grid:
    return Grid(cells=np.zeros((size, size), np.uint8), resolution=_RESOLUTION)


def _path(costmap: Costmap, end: float) -> NDArray[np.float64]:
    return run_to_end(plan(costmap, (1.0, 1.0, 0.0), (end, end, 0.0), Settings()))


def _anew(layered: LayeredCostmap) -> None:
    layered.invalidate()
    layered.update(_HERE, 0)


def _seen(layered: LayeredCostmap, buffer: ObservationBuffer) -> None:
    buffer.add(np.array([_HERE[0], _HERE[1], 0.2]), scan(_HERE[0], _HERE[1]), 0)
    layered.update(_HERE, 0)


if __name__ == "__main__":
    show(rows())
