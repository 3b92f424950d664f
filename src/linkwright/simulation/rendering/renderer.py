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

_INTO_LINK = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""The axes of images in those of links: cameras look along x, with z up."""


class Channels(Flag):
    """The channels of an image that can be requested."""

    COLOUR = auto()
    DEPTH = auto()
    GEOMS = auto()


@dataclass(frozen=True, slots=True)
class RenderedImage:
    """A rendered image; channels that were not requested are None.

    Attributes:
        colour: red, green, blue: shape (height, width, 3), uint8.
        depth: distance along the optical axis in m, inf where there is nothing nearer than `far`: shape (height,
            width).
        geoms: the index of the geom in MuJoCo's model, -1 for none: shape (height, width).
    """

    colour: Pixels | None
    depth: Pixels | None
    geoms: Pixels | None


class Renderer(Protocol):
    """The interface of renderers, which are used in the thread of the simulation."""

    way: Phrase
    """How it does so, for people."""

    def render(self, optics: Optics, pose: Transform, channels: Channels) -> RenderedImage:
        """Render the current view of a camera.

        Args:
            optics: the projection of the camera.
            pose: the pose of the camera in the world; the camera looks along x, with z up.
            channels: the requested channels.
        """

    def close(self) -> None:
        """Free the system resources of the renderer."""


def axes_of(pose: Transform) -> Array:
    """Return the image axes of a camera in the world as columns: right, down, forwards."""
    axes: Array = rotation_matrix(np.array(pose[3:])) @ _INTO_LINK
    return axes
