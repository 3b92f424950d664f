"""Mass properties of links from their shapes: computing them, judging them, writing them into the file."""

from typing import TYPE_CHECKING

from linkwright.deferred import deferred
from linkwright.inertia.inertial import from_inertial, to_inertial

if TYPE_CHECKING:
    from linkwright.inertia.estimation import DEFAULT_DENSITY, Estimate, ShapeKind, estimate
    from linkwright.inertia.mesh_library import MeshLibrary

__all__ = ["DEFAULT_DENSITY", "Estimate", "MeshLibrary", "ShapeKind", "estimate", "from_inertial", "to_inertial"]

__getattr__ = deferred(
    __name__,
    {
        "estimation": ("DEFAULT_DENSITY", "Estimate", "ShapeKind", "estimate"),
        "mesh_library": ("MeshLibrary",),
    },
)
"""The modules that read meshes; the inertias that a description has are asked for without."""
