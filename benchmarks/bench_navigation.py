"""Measure the processor time of costmap updates and plans, in a house and a large hall.

Run it with ``python -m benchmarks navigation``. The maps have 25 rooms with doors and cells of 5 cm. Plans lead from
one corner to the opposite one and to the middle. The figures are processor times, the minimum of several turns.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from benchmarks.measure import Row, show
from linkwright.navigation.costmaps.costmap import Costmap
from linkwright.navigation.costmaps.footprints import make_circle
from linkwright.navigation.costmaps.inflation_layer import Inflation, InflationLayer
from linkwright.navigation.costmaps.layered import LayeredCostmap
from linkwright.navigation.costmaps.observations import ObservationBuffer, Source
from linkwright.navigation.costmaps.obstacle_layer import HeightRange, ObstacleLayer
from linkwright.navigation.costmaps.static_layer import Interpretation, StaticLayer
from linkwright.navigation.costmaps.voxel_layer import VoxelLayer, Voxels
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.planning.planner import Settings, plan, run_to_end
from linkwright.navigation.planning.smoothing import Smoothing, smooth_path

_RESOLUTION_M = 0.05
_ROOMS_PER_SIDE = 5
_WALL_CELLS, _DOOR_CELLS, _CORNER_CELLS = 3, 20, 8
_TURN_COUNT = 5
_RAY_COUNT = 360
_ROBOT_RADIUS_M = 0.2
_ROBOT_POSE = (5.0, 5.0, 0.0)
_INFLATION = Inflation(cost_scaling_factor=3.0)


def make_rooms(size: int) -> NDArray[np.int8]:
    """Return an occupancy grid of rooms with doors, shape (size, size)."""
    rng = np.random.default_rng(1)
    cells = np.zeros((size, size), np.int8)
    cells[[0, -1]] = 100
    cells[:, [0, -1]] = 100
    room = size // _ROOMS_PER_SIDE
    walls = [wall * room for wall in range(1, _ROOMS_PER_SIDE)]
    for wall in walls:
        cells[wall : wall + _WALL_CELLS] = 100
        cells[:, wall : wall + _WALL_CELLS] = 100
    for wall in walls:
        for door_index in range(_ROOMS_PER_SIDE):
            for part in (cells, cells.T):
                door = door_index * room + int(rng.integers(_CORNER_CELLS, room - _DOOR_CELLS - _CORNER_CELLS))
                part[wall : wall + _WALL_CELLS, door : door + _DOOR_CELLS] = 0
    return cells


def measure_milliseconds(work: Callable[..., object], *arguments: object, turns: int = _TURN_COUNT) -> float:
    """Return the processor time of a call in ms, the minimum of several turns."""
    best = float("inf")
    for _ in range(turns):
        begin = time.thread_time()
        work(*arguments)
        best = min(best, time.thread_time() - begin)
    return 1000.0 * best


def make_scan(x: float, y: float) -> NDArray[np.float64]:
    """Return points around a position, shape (rays, 3)."""
    angles = np.linspace(0.0, 2.0 * np.pi, _RAY_COUNT, endpoint=False)
    return np.stack((x + 2.3 * np.cos(angles), y + 2.3 * np.sin(angles), np.full(_RAY_COUNT, 0.2)), axis=-1)


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    return [*_measure_rooms(400, "50 ms"), *_measure_rooms(2000, "2000 ms"), _measure_local_costmap()]


def _measure_rooms(size: int, promised: str) -> list[Row]:
    """Measure a fixed costmap with a map, and plans from corner to corner and to the middle."""
    what = f"{size} x {size} cells"
    buffer = ObservationBuffer(Source(clearing=True, max_obstacle_height=2.0))
    static = StaticLayer(Interpretation())
    layers = [static, ObstacleLayer([buffer], HeightRange()), InflationLayer(_INFLATION)]
    layered = LayeredCostmap(_make_blank_grid(size), layers, make_circle(_ROBOT_RADIUS_M))
    static.set_map(Grid(cells=make_rooms(size), resolution=_RESOLUTION_M))
    table = [Row(f"costmap of {what}, all of it", measure_milliseconds(_update_completely, layered), "ms")]
    costmap = layered.costmap.copy()
    table.append(Row(f"costmap of {what}, a scan", measure_milliseconds(_update_with_scan, layered, buffer), "ms"))
    end, middle = (size - 25) * _RESOLUTION_M, (size / 2 + 30) * _RESOLUTION_M
    milliseconds = measure_milliseconds(_plan_path, costmap, end, turns=3)
    table.append(Row(f"plan over {what}, corner to corner", milliseconds, "ms", promised))
    table.append(
        Row(f"plan over {what}, to the middle", measure_milliseconds(_plan_path, costmap, middle, turns=3), "ms")
    )
    path = _plan_path(costmap, end)
    milliseconds = measure_milliseconds(smooth_path, path[:, :2], Smoothing(), costmap)
    table.append(Row(f"smoothing {len(path)} poses", milliseconds, "ms"))
    return table


def _measure_local_costmap() -> Row:
    """Measure a costmap that moves with the robot."""
    buffer = ObservationBuffer(Source(clearing=True, max_obstacle_height=2.0))
    layers = [VoxelLayer([buffer], HeightRange(), Voxels(z_voxels=16, z_resolution=0.05)), InflationLayer(_INFLATION)]
    local = LayeredCostmap(_make_blank_grid(60), layers, make_circle(_ROBOT_RADIUS_M), is_rolling=True)
    return Row(
        "local costmap of 60 x 60 cells with voxels, a scan",
        measure_milliseconds(_update_with_scan, local, buffer),
        "ms",
    )


def _make_blank_grid(size: int) -> Grid:
    return Grid(cells=np.zeros((size, size), np.uint8), resolution=_RESOLUTION_M)


def _plan_path(costmap: Costmap, end: float) -> NDArray[np.float64]:
    return run_to_end(plan(costmap, (1.0, 1.0, 0.0), (end, end, 0.0), Settings()))


def _update_completely(layered: LayeredCostmap) -> None:
    layered.invalidate()
    layered.update(_ROBOT_POSE, 0)


def _update_with_scan(layered: LayeredCostmap, buffer: ObservationBuffer) -> None:
    buffer.add(np.array([_ROBOT_POSE[0], _ROBOT_POSE[1], 0.2]), make_scan(_ROBOT_POSE[0], _ROBOT_POSE[1]), 0)
    layered.update(_ROBOT_POSE, 0)


if __name__ == "__main__":
    show(rows())
