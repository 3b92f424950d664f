"""The robot model, and the reading, writing and printing of URDF."""

from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.geometry.single import Pose, Quaternion, Vector3
from linkwright.loading.deferred import deferred
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.urdf.model import (
    Calibration,
    Collision,
    Dynamics,
    Geometry,
    Inertial,
    Joint,
    JointType,
    Limit,
    Link,
    Material,
    Mesh,
    Mimic,
    Robot,
    Safety,
    Visual,
)
from linkwright.urdf.reader import Reading, read
from linkwright.urdf.tree import children_of, parent_joints

if TYPE_CHECKING:
    from linkwright.urdf.gv import to_gv
    from linkwright.urdf.listing import tree_text
    from linkwright.urdf.writer import save

__all__ = [
    "Box",
    "Calibration",
    "Capsule",
    "Collision",
    "Cylinder",
    "Dynamics",
    "Geometry",
    "Inertial",
    "Joint",
    "JointType",
    "Limit",
    "Link",
    "Material",
    "Mesh",
    "Mimic",
    "Pose",
    "Quaternion",
    "Reading",
    "Robot",
    "Safety",
    "Sphere",
    "Vector3",
    "Visual",
    "children_of",
    "parent_joints",
    "read",
    "save",
    "to_gv",
    "tree_text",
]

__getattr__ = deferred(__name__, {"gv": ("to_gv",), "listing": ("tree_text",), "writer": ("save",)})
"""Functions for a robot that was read, imported when they are first used."""
