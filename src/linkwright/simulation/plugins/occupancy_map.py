"""Maps of worlds at a height: ``libgazebo_2Dmap_plugin.so`` and ``libgazebo_ros_2d_map.so``.

A service computes an occupancy grid of the collisions at a height. The free space is what a robot reaches from its
initial position; cells without free neighbors are unknown.

Source: gazebo_ros_2Dmap_plugin (parameters, defaults, topics, service, the values of the cells).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile
from linkwright.messages import Header, get_message
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.surfaces import find_surfaces

_GRID_TYPE = "nav_msgs/msg/OccupancyGrid"
_UNKNOWN, _FREE, _OCCUPIED = -1, 0, 100
_LINES_PER_CELL = 2
_NEIGHBORS = np.array([(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1) if (x, y) != (0, 0)])
Cells = np.ndarray[Any, np.dtype[np.int8]]


@dataclass(frozen=True, kw_only=True)
class MapParameters:
    """Parameters of ``libgazebo_2Dmap_plugin.so``."""

    map_resolution: float = 0.1
    map_height: float = parameter(0.3, aliases=("map_z",))
    map_size_x: float = 10.0
    map_size_y: float = 10.0
    init_robot_x: float = 0.0
    init_robot_y: float = 0.0


class OccupancyMap(SimulatedPlugin[MapParameters]):
    """The substitute for ``libgazebo_2Dmap_plugin.so``.

    ``std_srvs/srv/Empty`` on ``/gazebo_2Dmap_plugin/generate_map`` publishes the map on ``/map2d``.
    """

    PARAMETERS = MapParameters

    def start(self) -> None:
        """Create the service, and the publisher of the map."""
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._output = self.node.publisher(_GRID_TYPE, "/map2d", qos)
        self.node.service("std_srvs/srv/Empty", "/gazebo_2Dmap_plugin/generate_map", self._generate)

    def _generate(self, _: Any, response: Any) -> Any:
        parameters = self.parameters
        cells = self._compute_cells()
        message = get_message(_GRID_TYPE)(header=Header(stamp=self.stamp(), frame_id="odom"))
        message.info.resolution = parameters.map_resolution
        message.info.height, message.info.width = cells.shape
        position = message.info.origin.position
        position.x, position.y, position.z = -parameters.map_size_x / 2, -parameters.map_size_y / 2, 0.0
        message.info.origin.orientation.w = 1.0
        message.data = cells.ravel()
        self._output.publish(message)
        return response

    def _compute_cells(self) -> Cells:
        """Return the values of the cells, shape (rows, columns); rows are along y."""
        parameters, resolution = self.parameters, self.parameters.map_resolution
        sizes = np.array((parameters.map_size_x, parameters.map_size_y))
        columns, rows = (int(count) for count in np.maximum(np.floor(sizes / resolution + 1e-9), 1))
        self.simulation.refresh()
        is_hit = np.zeros((rows, columns), dtype=bool)
        for axis in (0, 1):
            for x, y in self._find_surfaces(axis, sizes):
                column, row = int((x + sizes[0] / 2) / resolution), int((y + sizes[1] / 2) / resolution)
                if 0 <= row < rows and 0 <= column < columns:
                    is_hit[row, column] = True
        start = (np.array((parameters.init_robot_y, parameters.init_robot_x)) + sizes[::-1] / 2) // resolution
        is_free = _spread(is_hit, start.astype(int))
        cells: Cells = np.full((rows, columns), _UNKNOWN, dtype=np.int8)
        cells[is_hit & _find_neighbors(is_free)] = _OCCUPIED
        cells[is_free] = _FREE
        return cells

    def _find_surfaces(self, axis: int, sizes: Any) -> list[tuple[float, float]]:
        """Return the points in m where lines along an axis meet collisions at the height of the map."""
        simulation, spacing = self.simulation, self.parameters.map_resolution / _LINES_PER_CELL
        points = []
        for across in np.arange(-sizes[1 - axis] / 2 + spacing / 2, sizes[1 - axis] / 2, spacing):
            start = [0.0, 0.0, self.parameters.map_height]
            start[axis], start[1 - axis] = -sizes[axis] / 2, across
            surfaces = find_surfaces(simulation, start, axis, sizes[axis])
            points += [(surface, float(across)) if axis == 0 else (float(across), surface) for surface in surfaces]
        return points


def _spread(is_hit: Any, start: Any) -> Any:
    """Return which cells are reached from a cell without crossing occupied cells, in eight directions."""
    is_free, shape = np.zeros_like(is_hit), np.array(is_hit.shape)
    front = start[None, :]
    while True:
        front = front[((front >= 0) & (front < shape)).all(axis=1)]
        front = front[~is_hit[front[:, 0], front[:, 1]] & ~is_free[front[:, 0], front[:, 1]]]
        if not len(front):
            return is_free
        is_free[front[:, 0], front[:, 1]] = True
        front = np.unique((front[:, None, :] + _NEIGHBORS).reshape(-1, 2), axis=0)


def _find_neighbors(cells: Any) -> Any:
    """Return which cells have a marked neighbor in one of eight directions."""
    padded = np.pad(cells, 1)
    rows, columns = cells.shape
    return np.any([padded[1 + y : 1 + y + rows, 1 + x : 1 + x + columns] for y, x in _NEIGHBORS.tolist()], axis=0)
