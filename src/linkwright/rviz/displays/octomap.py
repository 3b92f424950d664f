"""The display octomap_rviz_plugins/OccupancyGrid."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.diagnostics import foreign, phrase
from linkwright.geometry.single import IDENTITY
from linkwright.graph import QoSProfile
from linkwright.rviz.config.property_store import qos_of
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.base.stored_markers import StoredMarkersDisplay
from linkwright.rviz.displays.base.topic_display import TRANSFORM
from linkwright.rviz.displays.moveit.octree import BadOctreeError, Cells, read_octree
from linkwright.rviz.displays.moveit.properties import fraction
from linkwright.rviz.displays.moveit.voxels import (
    BY_PROBABILITY,
    VOXEL_COLORING,
    VOXEL_RENDERING,
    octomap_markers,
    rendered,
)

_TOPIC = "Octomap Topic"
_MOST = 3.4028234663852886e38
"""The value of a property that means infinity."""

_DEPTH = 16
_MAP = "Octomap"


class OctomapDisplay(StoredMarkersDisplay):
    """A display of an octomap as boxes, at the current pose of the frame in the message's header."""

    CLASS = "octomap_rviz_plugins/OccupancyGrid"
    MESSAGE = "octomap_msgs/msg/Octomap"
    DRAWN_AS = "rviz_default_plugins/MarkerArray"
    TOPIC = (_TOPIC,)
    SCHEMA = (
        topic_spec(_TOPIC, description=MESSAGE, messages=(MESSAGE,)),
        VOXEL_RENDERING,
        VOXEL_COLORING,
        fraction("Voxel Alpha", 1.0, "Opacity of the cells."),
        PropertySpec(
            "Max. Octree Depth",
            "int",
            _DEPTH,
            "Levels below the root; one level less doubles the size of cells.",
            minimum=1,
            maximum=_DEPTH,
        ),
        PropertySpec("Max. Height Display", "float", _MOST, "The maximum height of cells that are drawn, in metres."),
        PropertySpec("Min. Height Display", "float", -_MOST, "The minimum height of cells that are drawn, in metres."),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._shown: set[str] = set()
        self._frame = ""

    def subscription(self) -> tuple[str, str, QoSProfile]:
        """Return the message type, topic and QoS to subscribe with."""
        return self.MESSAGE, self.properties.text(_TOPIC).strip(), qos_of(self.properties, _TOPIC)

    def changed(self, path: Path) -> None:
        """Subscribe to another topic, or redraw the last map."""
        if path[0] == _TOPIC:
            self._restart()
        else:
            self.show_again()

    def frames_changed(self) -> None:
        """Show in the status whether the pose of the map's frame is known."""
        problem = self.host.frames.problem(self._frame) if self._frame else None
        if problem:
            self.set_status_row(TRANSFORM, "error", problem)
        elif self._frame:
            self.set_status_row(TRANSFORM, "ok", phrase("Transform OK"))

    def reset(self) -> None:
        """Discard the map."""
        self._frame = ""
        self._shown.clear()
        self._store.clear()
        self.show_markers()

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Draw a map."""
        data = np.asarray(message.data, dtype=np.int8).tobytes()
        try:
            cells = read_octree(data=data, binary=message.binary, kind=message.id, resolution=message.resolution)
        except BadOctreeError as error:
            self.reset()
            self.set_status_row(_MAP, "error", foreign(error))
            return
        self.delete_status_row(_MAP)
        self._frame = message.header.frame_id.removeprefix("/")
        markers = octomap_markers(
            self._chosen(cells, message.resolution),
            "octomap",
            frame=self._frame,
            base=IDENTITY,
            alpha=self.properties.number("Voxel Alpha"),
            by_probability=self.properties.text("Voxel Coloring") == BY_PROBABILITY,
        )
        for gone in self._shown - {marker.id for marker in markers}:
            self._store.remove(gone)
        self._shown = {marker.id for marker in markers}
        for marker in markers:
            self._store.put(marker)
        self.show_markers()
        self.frames_changed()

    def _chosen(self, cells: Cells, resolution: float) -> Cells:
        """Return the cells to draw: those of the selected kind and height, no smaller than the depth allows.

        Smaller cells are merged, and the merged cell has the largest of their probabilities.
        """
        cells = rendered(cells, self.properties.text("Voxel Rendering"))
        height = cells.centers[:, 2]
        lowest, highest = (self.properties.number(f"{which}. Height Display") for which in ("Min", "Max"))
        cells = cells.chosen((height >= lowest) & (height <= highest))
        least = resolution * 2 ** (_DEPTH - int(self.properties.number("Max. Octree Depth")))
        small = cells.sizes < least * 0.75
        if not small.any():
            return cells
        places, inverse = np.unique(np.floor(cells.centers[small] / least), axis=0, return_inverse=True)
        probabilities = np.zeros(len(places))
        np.maximum.at(probabilities, inverse.reshape(-1), cells.probabilities[small])
        large = cells.chosen(~small)
        return Cells(
            np.concatenate([large.centers, (places + 0.5) * least]),
            np.concatenate([large.sizes, np.full(len(places), least)]),
            np.concatenate([large.probabilities, probabilities]),
        )
