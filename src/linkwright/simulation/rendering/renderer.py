"""The interface of renderers, and the images that they return."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Flag, auto
from typing import Any, Protocol

import numpy as np

from linkwright.diagnostics import Phrase
from linkwright.geometry.arrays import Array, rotation_matrix
from linkwright.geometry.single import Transform
from linkwright.sdf.optics import Optics

Pixels = np.ndarray[Any, np.dtype[Any]]

_IMAGE_AXES = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""The axes of images in the frame of the camera as columns: cameras look along x, with z up."""


class Channels(Flag):
    """The channels of a rendered image that a caller can request."""

    COLOR = auto()
    DEPTH = auto()
    GEOMS = auto()


@dataclass(frozen=True, slots=True)
class RenderedImage:
    """A rendered image.

    Channels that were not requested are None.

    Attributes:
        color: the red, green and blue of each pixel, shape (height, width, 3), uint8.
        depth: the distance along the optical axis in m, shape (height, width); inf if nothing is nearer than the far
            clip plane.
        geoms: the index of the visible geom in MuJoCo's model, shape (height, width); -1 for none.
    """

    color: Pixels | None
    depth: Pixels | None
    geoms: Pixels | None


class Renderer(Protocol):
    """The interface of renderers.

    All methods are called in the thread of the simulation.
    """

    method: Phrase
    """The method of rendering, as a phrase for log messages."""

    def render(self, optics: Optics, pose: Transform, channels: Channels) -> RenderedImage:
        """Render the current view of a camera.

        Args:
            optics: the projection of the camera.
            pose: the pose of the camera in the world; the camera looks along x, with z up.
            channels: the channels to render.
        """

    def close(self) -> None:
        """Free the system resources of the renderer."""


def compute_image_axes(pose: Transform) -> Array:
    """Return the image axes of a camera in the world as columns, shape (3, 3).

    The axes point right, down and forwards.
    """
    axes: Array = rotation_matrix(np.array(pose[3:])) @ _IMAGE_AXES
    return axes
