"""The display octomap_rviz_plugins/OccupancyGrid."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.diagnostics import foreign, phrase
from linkwright.geometry.single import IDENTITY
from linkwright.graph import QoSProfile
from linkwright.rviz.config.property_store import qos_from_properties
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.base.stored_markers import StoredMarkersDisplay
from linkwright.rviz.displays.base.topic_display import TRANSFORM
from linkwright.rviz.displays.moveit.octree import BadOctreeError, Cells, read_octree
from linkwright.rviz.displays.moveit.properties import fraction_spec
from linkwright.rviz.displays.moveit.voxels import (
    BY_PROBABILITY,
    VOXEL_COLORING,
    VOXEL_RENDERING,
    make_octomap_markers,
    select_rendered,
)

_TOPIC = "Octomap Topic"
_MAX_FLOAT = 3.4028234663852886e38
"""The property value that means infinity, as in RViz."""

_MAX_DEPTH = 16
_MAP_ROW = "Octomap"


class OctomapDisplay(StoredMarkersDisplay):
    """A display of an octomap as boxes, at the current pose of the message's frame."""

    CLASS = "octomap_rviz_plugins/OccupancyGrid"
    MESSAGE = "octomap_msgs/msg/Octomap"
    DRAWN_AS = "rviz_default_plugins/MarkerArray"
    TOPIC = (_TOPIC,)
    SCHEMA = (
        topic_spec(_TOPIC, description=MESSAGE, messages=(MESSAGE,)),
        VOXEL_RENDERING,
        VOXEL_COLORING,
        fraction_spec("Voxel Alpha", 1.0, "Opacity of the cells."),
        PropertySpec(
            "Max. Octree Depth",
            "int",
            _MAX_DEPTH,
            "Levels below the root; one level less doubles the size of cells.",
            minimum=1,
            maximum=_MAX_DEPTH,
        ),
        PropertySpec("Max. Height Display", "float", _MAX_FLOAT, "The maximum height of drawn cells, in meters."),
        PropertySpec("Min. Height Display", "float", -_MAX_FLOAT, "The minimum height of drawn cells, in meters."),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._shown_ids: set[str] = set()
        self._frame = ""

    def subscription(self) -> tuple[str, str, QoSProfile]:
        """Return the message type, topic and QoS to subscribe with."""
        return self.MESSAGE, self.properties.text(_TOPIC).strip(), qos_from_properties(self.properties, _TOPIC)

    def on_property_changed(self, path: Path) -> None:
        """Subscribe to another topic, or redraw the last map."""
        if path[0] == _TOPIC:
            self._restart()
        else:
            self.show_again()

    def on_frames_changed(self) -> None:
        """Show in the status whether the pose of the map's frame is known."""
        problem = self.host.frames.find_problem(self._frame) if self._frame else None
        if problem:
            self.set_status_row(TRANSFORM, "error", problem)
        elif self._frame:
            self.set_status_row(TRANSFORM, "ok", phrase("Transform OK"))

    def reset(self) -> None:
        """Discard the map."""
        self._frame = ""
        self._shown_ids.clear()
        self._store.clear()
        self.show_markers()

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Draw an octomap, or show in the status why it cannot be drawn."""
        data = np.asarray(message.data, dtype=np.int8).tobytes()
        try:
            cells = read_octree(data=data, binary=message.binary, kind=message.id, resolution=message.resolution)
        except BadOctreeError as error:
            self.reset()
            self.set_status_row(_MAP_ROW, "error", foreign(error))
            return
        self.delete_status_row(_MAP_ROW)
        self._frame = message.header.frame_id.removeprefix("/")
        markers = make_octomap_markers(
            self._select_cells(cells, message.resolution),
            "octomap",
            frame=self._frame,
            base=IDENTITY,
            alpha=self.properties.number("Voxel Alpha"),
            by_probability=self.properties.text("Voxel Coloring") == BY_PROBABILITY,
        )
        for stale_id in self._shown_ids - {marker.id for marker in markers}:
            self._store.remove(stale_id)
        self._shown_ids = {marker.id for marker in markers}
        for marker in markers:
            self._store.put(marker)
        self.show_markers()
        self.on_frames_changed()

    def _select_cells(self, cells: Cells, resolution: float) -> Cells:
        """Return the cells of the selected kind and height, at the selected maximum depth.

        Smaller cells are merged. A merged cell has the largest probability of its parts.
        """
        cells = select_rendered(cells, self.properties.text("Voxel Rendering"))
        height = cells.centers[:, 2]
        min_height, max_height = (self.properties.number(f"{bound}. Height Display") for bound in ("Min", "Max"))
        cells = cells.select((height >= min_height) & (height <= max_height))
        min_size = resolution * 2 ** (_MAX_DEPTH - int(self.properties.number("Max. Octree Depth")))
        is_small = cells.sizes < min_size * 0.75
        if not is_small.any():
            return cells
        indices, inverse = np.unique(np.floor(cells.centers[is_small] / min_size), axis=0, return_inverse=True)
        probabilities = np.zeros(len(indices))
        np.maximum.at(probabilities, inverse.reshape(-1), cells.probabilities[is_small])
        large_cells = cells.select(~is_small)
        return Cells(
            np.concatenate([large_cells.centers, (indices + 0.5) * min_size]),
            np.concatenate([large_cells.sizes, np.full(len(indices), min_size)]),
            np.concatenate([large_cells.probabilities, probabilities]),
        )
