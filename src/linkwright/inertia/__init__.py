"""Mass properties of links from their shapes: computing them, judging them, writing them into the file."""

from linkwright.inertia.estimate import DEFAULT_DENSITY, Estimate, ShapeKind, estimate
from linkwright.inertia.inertial import from_inertial, to_inertial
from linkwright.inertia.mesh_library import MeshLibrary

__all__ = ["DEFAULT_DENSITY", "Estimate", "MeshLibrary", "ShapeKind", "estimate", "from_inertial", "to_inertial"]
