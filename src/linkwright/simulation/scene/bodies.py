"""Convert links to MuJoCo bodies: mass, joints, collision geoms and visual geoms."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from math import isfinite
from typing import Any

import numpy as np

from linkwright.diagnostics import Diagnostic, Phrase, Severity, phrase
from linkwright.geometry.arrays import rotation_matrix
from linkwright.geometry.mass import combine
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.geometry.single import Pose, Transform, Vector3, compose, invert, rotate
from linkwright.geometry.solids import shape_properties
from linkwright.geometry.validity import TOLERANCE, is_positive_definite, triangle_excess
from linkwright.sdf.frames import Frames, pose_of, transform_of
from linkwright.sdf.joints import Axis
from linkwright.sdf.links import Collision, Inertia, Inertial, Link, Visual
from linkwright.sdf.poses import RawPose
from linkwright.sdf.values import Color
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.couplings import THREAD_SUFFIX
from linkwright.simulation.scene.meshes import MeshLibrary
from linkwright.simulation.scene.shapes import add_shape
from linkwright.simulation.scene.structure import PlacedJoint
from linkwright.simulation.scene.surfaces import apply_surface, get_grip
from linkwright.xmltree import Element

_MIN_MOMENT_RATIO = 1e-9
"""The margin of the triangle inequality that MuJoCo requires, as a fraction of the largest principal moment."""
COLLISION_GROUP, VISUAL_GROUP = 3, 2
"""MuJoCo's groups of collision geoms and of visual geoms."""
SECOND_AXIS_SUFFIX = "#2"
"""The suffix of the name of a joint's second axis."""

_MIN_MASS = 1e-6
"""The minimum mass in kg, because MuJoCo does not move bodies without mass."""
_MIN_INERTIA = 1e-9
"""The minimum inertia in kg m2 that replaces an impossible inertia."""
_MIN_MOMENT = 1e-12
"""The minimum moment of inertia in kg m2, because MuJoCo treats moments below 1e-14 as zero."""
_MIN_RANGE = 2e-6
"""The minimum range of a joint in rad (or m), because MuJoCo has no joints with equal limits."""
_MAX_LIMIT = 1e6
"""The maximum limit of a joint in rad (or m)."""
_DEFAULT_INERTIAL = Inertial()
_GRAY: Color = (0.7, 0.7, 0.7, 1.0)
_WHITE: Color = (1.0, 1.0, 1.0, 1.0)
"""The color of a textured visual that has no color."""
_DEFAULT_DENSITY = 1000.0
"""The default density, in kg/m3."""


class BodyWriter:
    """A writer that adds links to a MuJoCo specification.

    Args:
        meshes: the library of meshes.

    Attributes:
        diagnostics: the findings on values and shapes that cannot be simulated.
        geoms_without_friction: names of the colliding geoms whose friction is not specified.
        grip_by_geom: the friction that geoms have when a motor turns them, by geom name.
    """

    def __init__(self, meshes: MeshLibrary) -> None:
        self.geoms_without_friction: set[str] = set()
        self.grip_by_geom: dict[str, float] = {}
        self.diagnostics: list[Diagnostic] = []
        self._meshes = meshes
        self._mujoco = load_mujoco()

    def set_mass(self, body: Any, link: Link, frames: Frames) -> None:
        """Set the mass properties of a body from its link.

        As in SDF, the defaults are 1 kg and 1 kg m2.

        Impossible values are replaced and reported.
        """
        inertial = link.inertial or _DEFAULT_INERTIAL
        if inertial.auto:
            inertial = _inertial_from_shapes(link, frames) or _DEFAULT_INERTIAL
        inertial_pose = transform_of(inertial.pose.pose)
        rotation = rotation_matrix(inertial_pose[3:])
        inertia = inertial.inertia
        tensor = np.array(
            [
                [inertia.ixx, inertia.ixy, inertia.ixz],
                [inertia.ixy, inertia.iyy, inertia.iyz],
                [inertia.ixz, inertia.iyz, inertia.izz],
            ]
        )
        with np.errstate(invalid="ignore", over="ignore"):
            tensor = rotation @ tensor @ rotation.T
        mass = inertial.mass
        if not (isfinite(mass) and mass >= _MIN_MASS):
            message = phrase(
                "link '{name}' has a mass of {mass} kg, but is simulated with {minimum} kg",
                name=link.name,
                mass=mass,
                minimum=_MIN_MASS,
            )
            self._warn("SIM110", message, inertial.element or link.element)
            mass = _MIN_MASS
        if not np.isfinite(tensor).all() or not is_positive_definite(tensor):
            if not (np.isfinite(tensor).all() and not tensor.any()):
                message = phrase(
                    "the inertia of link '{name}' is not physically possible; the inertia of a ball with "
                    "the same mass is used instead",
                    name=link.name,
                )
                self._warn("SIM111", message, inertial.element or link.element)
            tensor = np.eye(3) * max(mass * 1e-4, _MIN_INERTIA)
        excess = triangle_excess(tensor)
        if excess > TOLERANCE:
            message = phrase(
                "the inertia of link '{name}' is not physically possible; the mean of its moments is used instead",
                name=link.name,
            )
            self._warn("SIM111", message, inertial.element or link.element)
        elif excess > -_MIN_MOMENT_RATIO:  # With a rounding error, MuJoCo would use the mean moment.
            tensor = tensor + np.eye(3) * np.trace(tensor) / 2 * (max(excess, 0.0) + _MIN_MOMENT_RATIO)
        min_moment = float(np.linalg.eigvalsh(tensor)[0])
        if min_moment < _MIN_MOMENT:
            tensor = tensor + np.eye(3) * (_MIN_MOMENT - min_moment)
        body.explicitinertial = True
        body.mass = mass
        body.ipos = list(inertial_pose[:3])
        body.fullinertia = [tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[0, 2], tensor[1, 2]]

    def add_joint(self, body: Any, scene_joint: PlacedJoint, child: Transform) -> None:
        """Add the MuJoCo joints that represent a joint to the body of the joint's child.

        Args:
            body: the body of the child link.
            scene_joint: the joint.
            child: the pose of the child link in the world.
        """
        joint_types = self._mujoco.mjtJoint
        pose_in_child = compose(invert(child), scene_joint.pose)
        kind = scene_joint.joint.type
        if kind == "fixed":
            return
        if kind == "ball":
            body.add_joint(name=scene_joint.name, type=joint_types.mjJNT_BALL, pos=list(pose_in_child[:3]))
            return
        is_prismatic = kind == "prismatic"
        count = 2 if kind in ("universal", "revolute2") else 1
        for axis, direction in scene_joint.axes[:count]:
            name = scene_joint.name if axis is scene_joint.joint.axis else scene_joint.name + SECOND_AXIS_SUFFIX
            joint = body.add_joint(
                name=name,
                type=joint_types.mjJNT_SLIDE if is_prismatic else joint_types.mjJNT_HINGE,
                pos=list(pose_in_child[:3]),
                axis=list(rotate(pose_in_child[3:], direction)),
            )
            self._apply_limits(joint, axis, endless=kind == "continuous")
            if kind == "screw":
                anchor, direction_in_child = list(pose_in_child[:3]), list(rotate(pose_in_child[3:], direction))
                body.add_joint(
                    name=scene_joint.name + THREAD_SUFFIX,
                    type=joint_types.mjJNT_SLIDE,
                    pos=anchor,
                    axis=direction_in_child,
                )

    def _apply_limits(self, joint: Any, axis: Axis, *, endless: bool) -> None:
        limit, dynamics = axis.limit, axis.dynamics
        if not endless and (isfinite(limit.lower) or isfinite(limit.upper)):
            set_joint_range(joint, limit.lower, limit.upper)
        joint.actfrclimited = isfinite(limit.effort) and limit.effort > 0
        if joint.actfrclimited:
            joint.actfrcrange = [-limit.effort, limit.effort]
        set_coefficient(joint, "damping", max(dynamics.damping, 0.0))
        set_coefficient(joint, "stiffness", max(dynamics.spring_stiffness, 0.0))
        joint.springref = dynamics.spring_reference
        joint.frictionloss = max(dynamics.friction, 0.0)

    def add_visuals(self, body: Any, link: Link, frames: Frames, *, fixed: bool) -> None:
        """Add the visuals of a link as geoms without contacts."""
        counts: Counter[str] = Counter()
        for visual in link.visuals:
            pose = frames.in_link(visual.pose, link.name)
            for geom in self._add_geoms(body, visual, pose, counts, fixed=fixed):
                geom.group = VISUAL_GROUP
                geom.contype = geom.conaffinity = 0
                if visual.material is not None:
                    geom.material = (
                        self._meshes.find_material(visual) if self._meshes.has_texture_coordinates(geom) else ""
                    )
                if visual.material is not None or not geom.material:
                    geom.rgba = _get_color(visual, _WHITE if geom.material else _GRAY)

    def add_collisions(self, body: Any, link: Link, frames: Frames, *, fixed: bool, rolls: bool = False) -> None:
        """Add the collisions of a link as geoms, and record their friction.

        `fixed` and `rolls` are those of `MeshLibrary.collisions`.
        """
        counts: Counter[str] = Counter()
        for collision in link.collisions:
            pose = frames.in_link(collision.pose, link.name)
            surface = collision.surface
            for geom in self._add_geoms(body, collision, pose, counts, fixed=fixed, rolls=rolls):
                geom.group = COLLISION_GROUP
                geom.contype, geom.conaffinity = surface.category_bitmask, surface.collide_bitmask
                apply_surface(geom, surface)
                self.grip_by_geom[geom.name] = get_grip(surface)
                if surface.friction is None:
                    self.geoms_without_friction.add(geom.name)

    def _add_geoms(
        self,
        body: Any,
        item: Visual | Collision,
        pose: Transform,
        counts: Counter[str],
        *,
        fixed: bool,
        rolls: bool = False,
    ) -> Iterable[Any]:
        """Add the geoms of a visual or collision to a body, name them, and return them.

        `counts` contains the number of geoms with each name, because names must be unique in a body.
        """
        is_collision = isinstance(item, Collision)
        geoms = [] if isinstance(item, Collision) else self._meshes.add_textured_shape(body, item, pose)
        simple_geom = None if geoms else add_shape(body, item.geometry, pose, fixed=fixed)
        if simple_geom is not None:
            geoms = [simple_geom]
        elif isinstance(item, Collision):
            geoms = self._meshes.collisions(body, item.geometry, pose, item.element, fixed=fixed, rolls=rolls)
        elif not geoms:
            geoms = self._meshes.visuals(body, item.geometry, pose, item.element)
        for geom in geoms:
            index = counts[item.name]
            counts[item.name] += 1
            suffix = f"#{index}" if index else ""
            geom.name = f"{body.name}::{item.name}#{'collision' if is_collision else 'visual'}{suffix}"
        return geoms

    def _warn(self, code: str, message: Phrase, element: Element | None) -> None:
        span = element.span() if element is not None else None
        source = element.source if element is not None else None
        self.diagnostics.append(Diagnostic(code, message, severity=Severity.WARNING, span=span, source=source))


def _inertial_from_shapes(link: Link, frames: Frames) -> Inertial | None:
    """Return the mass properties of a link's simple collision shapes, or None for no mass."""
    assert link.inertial is not None
    properties = []
    for collision in link.collisions:
        if isinstance(collision.geometry, Box | Capsule | Cylinder | Sphere):
            density = collision.density or link.inertial.density or _DEFAULT_DENSITY
            pose = pose_of(frames.in_link(collision.pose, link.name))
            properties.append(shape_properties(collision.geometry, density).moved(pose))
    total = combine(properties)
    if not total.mass > 0:
        return None
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = total.inertia.tolist()
    x, y, z = total.center.tolist()
    return Inertial(total.mass, RawPose(Pose((x, y, z))), Inertia(ixx, iyy, izz, ixy, ixz, iyz))


def _get_color(visual: Visual, default: Color) -> list[float]:
    material = visual.material
    red, green, blue, alpha = (material.diffuse if material is not None else None) or default
    return [min(max(value, 0.0), 1.0) for value in (red, green, blue, alpha * (1.0 - visual.transparency))]


def set_joint_range(joint: Any, lower: float, upper: float) -> None:
    """Limit the position of a joint to a range in rad (or m).

    A joint with equal limits cannot move. Limits in the wrong order are ignored, as Gazebo's physics engines do.
    """
    lower, upper = max(lower, -_MAX_LIMIT), min(upper, _MAX_LIMIT)
    joint.limited = lower <= upper
    if joint.limited:
        play = max(_MIN_RANGE - (upper - lower), 0.0) / 2
        joint.range = [lower - play, upper + play]


def set_coefficient(element: Any, name: str, value: float) -> None:
    """Set a scalar attribute of an element, or the first term if MuJoCo 4 stores a polynomial."""
    current_value = getattr(element, name)
    if np.ndim(current_value):
        current_value[0] = value
    else:
        setattr(element, name, value)


def compute_hinge_anchors(placed: PlacedJoint, distance: float) -> list[Vector3]:
    """Return two points on the axis of a joint, in the world, at the given distance in m.

    Fixing both points allows only rotation about this axis.
    """
    x, y, z = placed.pose[:3]
    _, direction = placed.axes[0]
    dx, dy, dz = (distance * value for value in rotate(placed.pose[3:], direction))
    return [(x, y, z), (x + dx, y + dy, z + dz)]
