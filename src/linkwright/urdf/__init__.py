"""The robot model: reading, writing and printing URDF."""

from linkwright.urdf.gv import to_gv
from linkwright.urdf.library import DescriptionLibrary, examine, load
from linkwright.urdf.listing import tree_text
from linkwright.urdf.model import (
    Box,
    Calibration,
    Capsule,
    Collision,
    Cylinder,
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
    Pose,
    Quaternion,
    Robot,
    Safety,
    Sphere,
    Vector3,
    Visual,
)
from linkwright.urdf.reader import Reading, read
from linkwright.urdf.tree import children_of, parent_joints
from linkwright.urdf.writer import save

__all__ = [
    "Box",
    "Calibration",
    "Capsule",
    "Collision",
    "Cylinder",
    "DescriptionLibrary",
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
    "examine",
    "load",
    "parent_joints",
    "read",
    "save",
    "to_gv",
    "tree_text",
]
