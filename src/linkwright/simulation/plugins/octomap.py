"""Maps of worlds in three dimensions: ``librotors_gazebo_octomap_plugin.so``.

A service computes an octree of the collisions in a box. Cells that contain a surface are occupied. The free space is
what is reached from the corner of the box at its top, and from the corner at its bottom; the rest is occupied, too.

Source: RotorS (parameters, defaults, topics, service, the states of the cells); OctoMap (the format of the file).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.octrees import encode_octree
from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile
from linkwright.messages import Header, get_message
from linkwright.sdf.poses import WORLD
from linkwright.sdf.worlds import SphericalCoordinates
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.surfaces import find_surfaces
from linkwright.simulation.sensors.earth import Globe

_MAP_TYPE, _SERVICE_TYPE = "octomap_msgs/msg/Octomap", "rotors_comm/srv/Octomap"
_MARGIN = 1e-5
"""The length in m that is added to the edges of the box, so that no center is between two cells."""
_MAX_CELLS = 50_000_000
_UNKNOWN, _FREE, _OCCUPIED = 0, 1, 2
_STEPS = tuple(step for step in product((-1, 0, 1), repeat=3) if sum(map(abs, step)) == 1)


@dataclass(frozen=True, kw_only=True)
class OctomapParameters:
    """Parameters of ``librotors_gazebo_octomap_plugin.so``."""

    octomap_pub_topic: str = parameter("world/octomap", aliases=("octomapPubTopic",))
    octomap_service_name: str = parameter("world/get_octomap", aliases=("octomapServiceName",))


class WorldOctomap(SimulatedPlugin[OctomapParameters]):
    """The substitute for ``librotors_gazebo_octomap_plugin.so``.

    ``rotors_comm/srv/Octomap`` returns the octree, publishes it, and writes it to a file, as requested.
    """

    PARAMETERS = OctomapParameters

    def start(self) -> None:
        """Create the service, and the publisher of the octree."""
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._output = self.node.publisher(_MAP_TYPE, self.parameters.octomap_pub_topic, qos)
        self.node.service(_SERVICE_TYPE, self.parameters.octomap_service_name, self._generate)

    def _generate(self, request: Any, response: Any) -> Any:
        globe = Globe(self.context.world.spherical_coordinates or SphericalCoordinates())
        latitude, longitude, altitude = globe.to_geodetic(np.zeros(3))
        response.origin_latitude, response.origin_longitude = float(latitude), float(longitude)
        response.origin_altitude = float(altitude)
        center, lengths = (
            np.array((point.x, point.y, point.z))
            for point in (request.bounding_box_origin, request.bounding_box_lengths)
        )
        leaf = request.leaf_size
        count = np.prod(np.maximum(lengths / leaf, 0.0)) if leaf > 0.0 else np.inf
        if not count <= _MAX_CELLS:
            message = phrase(
                "plugin '{plugin}': a box with cells of {leaf} m has more than {maximum} cells; choose a greater "
                "leaf_size, or a smaller box",
                plugin=self.context.name,
                leaf=leaf,
                maximum=_MAX_CELLS,
            )
            self.node.logger.error(message)
            return response
        first_center = center - (lengths + _MARGIN) / 2 + leaf / 2
        states = self._compute_states(first_center, lengths + _MARGIN, leaf)
        data, node_count = encode_octree(np.floor(first_center / leaf).astype(int), states)
        response.map = get_message(_MAP_TYPE)(
            header=Header(stamp=self.stamp(), frame_id=WORLD), binary=True, id="OcTree", resolution=leaf
        )
        response.map.data = np.frombuffer(data, dtype=np.int8)
        if request.filename:
            self._write(request.filename, data, node_count, leaf)
        if request.publish_octomap:
            self._output.publish(response.map)
        return response

    def _compute_states(self, first_center: Any, lengths: Any, leaf: float) -> Any:
        """Return the states of the cells of the box, shape (cells along x, y, z)."""
        shape = tuple(int(count) for count in np.maximum(np.ceil(lengths / leaf - 0.5), 0))
        states = np.zeros(shape, dtype=np.uint8)
        self.simulation.refresh()
        for axis in range(3):
            across = [other for other in range(3) if other != axis]
            for cell in np.ndindex(*(shape[other] for other in across)):
                start = first_center.copy()
                start[across] += np.array(cell) * leaf
                start[axis] -= leaf / 2
                index = list(cell)
                for surface in find_surfaces(self.simulation, start.tolist(), axis, shape[axis] * leaf):
                    position = min(int((surface - start[axis]) / leaf), shape[axis] - 1)
                    index.insert(axis, position)
                    states[tuple(index)] = _OCCUPIED
                    index.pop(axis)
        if states.size:
            _fill(states, (0, 0, shape[2] - 1))
            _fill(states, (0, 0, 0))
            states[states == _UNKNOWN] = _OCCUPIED
        return states

    def _write(self, filename: str, data: bytes, node_count: int, leaf: float) -> None:
        head = f"# Octomap OcTree binary file\n\nid OcTree\nsize {node_count}\nres {leaf:g}\ndata\n"
        try:
            Path(filename).write_bytes(head.encode() + data)
        except OSError as error:
            message = phrase("cannot write '{path}': {reason}", path=filename, reason=error.strerror or error)
            self.node.logger.warning(message)


def _fill(states: Any, start: tuple[int, int, int]) -> None:
    """Mark the unknown cells that are reached from a cell, in six directions, as free."""
    shape, steps = np.array(states.shape), np.array(_STEPS)
    front = np.array([start])
    while len(front):
        front = front[((front >= 0) & (front < shape)).all(axis=1)]
        front = front[states[tuple(front.T)] == _UNKNOWN]
        states[tuple(front.T)] = _FREE
        front = np.unique((front[:, None, :] + steps).reshape(-1, 3), axis=0)
