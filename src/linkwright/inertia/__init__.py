"""Mass properties of links from their shapes: computing them, judging them, writing them into the file."""

from linkwright.inertia.estimate import DEFAULT_DENSITY, Estimate, ShapeKind, estimate
from linkwright.inertia.mesh_library import MeshLibrary
from linkwright.inertia.meshes import MESH_ENDINGS, TriangleMesh, read_mesh
from linkwright.inertia.properties import MassProperties, PrincipalAxes, combine, from_inertial, to_inertial
from linkwright.inertia.shapes import shape_properties
from linkwright.inertia.validity import problems

__all__ = [
    "DEFAULT_DENSITY",
    "MESH_ENDINGS",
    "Estimate",
    "MassProperties",
    "MeshLibrary",
    "PrincipalAxes",
    "ShapeKind",
    "TriangleMesh",
    "combine",
    "estimate",
    "from_inertial",
    "problems",
    "read_mesh",
    "shape_properties",
    "to_inertial",
]
