"""Mass properties of links: computation from shapes, comparison with the file, and writing."""

from linkwright.loading.deferred import deferred
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.inertia.estimation import DEFAULT_DENSITY, Estimate, ShapeKind, estimate
    from linkwright.inertia.mesh_library import MeshLibrary

__all__ = ["DEFAULT_DENSITY", "Estimate", "MeshLibrary", "ShapeKind", "estimate"]

__getattr__ = deferred(
    __name__,
    {
        "estimation": ("DEFAULT_DENSITY", "Estimate", "ShapeKind", "estimate"),
        "mesh_library": ("MeshLibrary",),
    },
)
"""Names that are imported on first use, because most need numpy, and a check uses only the mesh library."""
