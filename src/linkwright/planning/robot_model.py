"""A robot in MuJoCo, for link frames, Jacobians and collisions.

Each link is a body whose frame is the link's frame, and each moving joint is a joint of MuJoCo at the origin of its
child's body. MuJoCo computes the frames and Jacobians of an arm in a few microseconds.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from linkwright.geometry.arrays import Array, row_from_pose
from linkwright.geometry.shapes import Box, Capsule, Cylinder, SimpleShape, Sphere
from linkwright.kinematics.tree import MOVING_TYPES, resolve_mimics
from linkwright.simulation.library import load_mujoco
from linkwright.urdf import Robot, children_of, parent_joints


class PlacedShape(NamedTuple):
    """A convex shape in the frame of a link or object.

    Attributes:
        shape: a simple shape, or the corners of a convex hull in m, shape (corners, 3).
        pose: the pose of the shape, shape (7,).
        center: the point in the frame of the shape from which a hull grows; None for the mean of its corners.
    """

    shape: SimpleShape | Array
    pose: Array
    center: Array | None = None


Shapes = Mapping[str, Sequence[PlacedShape]]
"""The collision shapes of links, by link name."""


class RobotModel:
    """A robot in MuJoCo, in a configuration that can be changed.

    Args:
        robot: the robot.
        shapes: the collision shapes of its links; None for a model without collisions.
        complete: called with the specification of the model before it is compiled, to add more to it.

    Attributes:
        joint_names: the joints that have a position of their own, in the order of positions.
        relations: the relation of each moving joint to the one that it mimics, by name.
        mujoco_model: the compiled model.
        data: the state of the model.
    """

    def __init__(
        self, robot: Robot, shapes: Shapes | None = None, complete: Callable[[Any], None] | None = None
    ) -> None:
        self._mujoco = mujoco = load_mujoco()
        moving = [joint.name for joint in robot.joints.values() if joint.type in MOVING_TYPES and any(joint.axis)]
        self.joint_names, self.relations = resolve_mimics(robot, moving)
        spec = mujoco.MjSpec()
        _add_robot(spec, robot, moving, shapes or {})
        if complete is not None:
            complete(spec)
        self.mujoco_model = spec.compile()
        self.data = mujoco.MjData(self.mujoco_model)
        self._expansion = _PositionExpansion(self.joint_names, self.relations, self.mujoco_model)
        self._indexes = {name: index for index, name in enumerate(self.joint_names)}

    def index(self, joint: str) -> int:
        """Return the index of a joint in `joint_names`."""
        return self._indexes[joint]

    def dof_indexes(self, joints: Iterable[str]) -> list[int]:
        """Return the columns of Jacobians that belong to joints."""
        return [int(self.mujoco_model.joint(name).dofadr[0]) for name in joints]

    def body(self, link: str) -> int:
        """Return the index of the body of a link.

        Raises:
            KeyError: the robot has no such link.
        """
        return int(self.mujoco_model.body(body_name(link)).id)

    def move(self, positions: Array) -> None:
        """Set the positions of all joints, and compute the link frames.

        The positions are in rad or m, in the order of `joint_names`.
        """
        self._expansion.write(positions, self.data.qpos)
        self._mujoco.mj_kinematics(self.mujoco_model, self.data)

    def all_positions(self) -> tuple[list[str], Array]:
        """Return the names and the current positions of all moving joints.

        Mimic joints are included.
        """
        names = [self.mujoco_model.joint(number).name for number in range(self.mujoco_model.njnt)]
        return names, self.data.qpos.copy()

    def link_pose(self, link: str) -> Array:
        """Return the pose of a link in the frame of the root link, shape (7,)."""
        body = self.body(link)
        w, x, y, z = self.data.xquat[body]
        return np.array((*self.data.xpos[body], x, y, z, w))


class _PositionExpansion:
    """The expansion of joint positions to all moving joints, including mimic joints."""

    def __init__(self, joint_names: Sequence[str], relations: Mapping[str, Any], model: Any) -> None:
        indexes = {name: index for index, name in enumerate(joint_names)}
        names = [model.joint(number).name for number in range(model.njnt)]
        leaders = [indexes.get(relations[name].leader, -1) for name in names]
        self._sources = np.maximum(np.array(leaders, dtype=np.intp), 0)
        is_moved = np.array([leader >= 0 for leader in leaders], dtype=bool)
        self._factors = np.array([relations[name].factor for name in names]) * is_moved
        self._offsets = np.array([relations[name].offset for name in names])

    def write(self, positions: Array, target: Array) -> None:
        """Write the positions of all moving joints into an array."""
        if len(self._sources):
            target[:] = positions[self._sources] * self._factors + self._offsets


def _add_robot(spec: Any, robot: Robot, moving_joints: Iterable[str], shapes: Shapes) -> None:
    """Add the links and the moving joints of a robot to a model."""
    mujoco = load_mujoco()
    moving = set(moving_joints)
    children, parents = children_of(robot), parent_joints(robot)
    pending = [(spec.worldbody, robot.root)]
    while pending:
        parent_body, link = pending.pop()
        joint = parents.get(link)
        body = parent_body.add_body(name=body_name(link), mass=1.0, inertia=[1.0, 1.0, 1.0], explicitinertial=True)
        if joint is not None:
            set_pose(body, row_from_pose(joint.origin))
            if joint.name in moving:
                kind = mujoco.mjtJoint.mjJNT_SLIDE if joint.type == "prismatic" else mujoco.mjtJoint.mjJNT_HINGE
                body.add_joint(name=joint.name, type=kind, axis=list(joint.axis))
        for placed_shape in shapes.get(link, ()):
            add_shape(spec, body, placed_shape)
        pending += [(body, child.child) for child in reversed(children[link]) if parents[child.child] is child]


def body_name(link: str) -> str:
    """Return the name of a link's body.

    It is not the link's name, because MuJoCo's own body is named ``world``, as many root links are.
    """
    return f"link {link}"


def add_shape(spec: Any, body: Any, placed_shape: PlacedShape) -> Any:
    """Add a collision shape to a body, and return its geom.

    Equal hulls share a mesh, because MuJoCo takes seconds to compute the hull of many points.
    """
    kinds, shape = load_mujoco().mjtGeom, placed_shape.shape
    geom = body.add_geom(mass=0.0)
    set_pose(geom, placed_shape.pose)
    if isinstance(shape, np.ndarray):
        name = f"hull {hashlib.sha256(shape.tobytes()).hexdigest()}"
        if spec.mesh(name) is None:
            mesh = spec.add_mesh(name=name, uservert=shape.ravel().tolist())
            mesh.inertia = load_mujoco().mjtMeshInertia.mjMESH_INERTIA_SHELL  # Thin meshes have too little volume.
        geom.type, geom.meshname = kinds.mjGEOM_MESH, name
    elif isinstance(shape, Box):
        geom.type, geom.size = kinds.mjGEOM_BOX, [length / 2 for length in shape.size]
    elif isinstance(shape, Sphere):
        geom.type, geom.size = kinds.mjGEOM_SPHERE, [shape.radius, 0.0, 0.0]
    else:
        assert isinstance(shape, (Cylinder, Capsule))
        geom.type = kinds.mjGEOM_CYLINDER if isinstance(shape, Cylinder) else kinds.mjGEOM_CAPSULE
        geom.size = [shape.radius, shape.length / 2, 0.0]
    return geom


def set_pose(part: Any, pose: Array) -> None:
    """Set the pose of a body or geom in its parent, shape (7,)."""
    x, y, z, qx, qy, qz, qw = pose.tolist()
    part.pos, part.quat = [x, y, z], [qw, qx, qy, qz]
