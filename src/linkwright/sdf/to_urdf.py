"""Converts a model in SDF to a robot in URDF, as ROS does if a robot description is SDF.

Source: the package sdformat_urdf, which is urdfdom's reader of SDF.
"""

from __future__ import annotations

from math import isinf

from linkwright.diagnostics import Phrase, phrase, term
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.geometry.single import IDENTITY, Transform, compose, invert
from linkwright.sdf.frames import FrameError, Frames, pose_of
from linkwright.sdf.joints import Axis, Joint
from linkwright.sdf.links import Collision, Inertial, Link, Visual
from linkwright.sdf.materials import Material
from linkwright.sdf.models import Model
from linkwright.sdf.poses import AT_ORIGIN, WORLD
from linkwright.sdf.report import SdfReport, described
from linkwright.sdf.shapes import Mesh, Shape
from linkwright.sdf.worlds import Sdf
from linkwright.urdf import Reading
from linkwright.urdf import model as urdf
from linkwright.xmltree import Element

_TYPES: dict[str, urdf.JointType] = {
    "revolute": "revolute",
    "hinge": "revolute",
    "continuous": "continuous",
    "prismatic": "prismatic",
    "fixed": "fixed",
}
"""SDF joint types and their URDF types; all others need a transform of their own: they float."""
_UNBOUNDED = 1e16
"""SDF's number for an unbounded limit, which represents it in URDF too, because URDF has none of its own."""
_AMBIENT, _DIFFUSE = 0.4, 0.8
"""The light of Gazebo's usual world, in which sdformat_urdf looks at a material to find the colour that it has."""


class _NoRobotError(Exception):
    """Raised when a model cannot be converted to a robot; carries the reason, an element and a hint."""

    def __init__(self, reason: Phrase, element: Element | None, hint: Phrase | None = None) -> None:
        super().__init__(reason)
        self.reason = reason
        self.element = element
        self.hint = hint


def robot_from_sdf(sdf: Sdf, root: Element) -> Reading:
    """Convert the model of an SDF document to a robot.

    In URDF, the frame of a link is the frame of its parent joint, so the parts of the link are moved. Addresses of
    meshes are not changed. Sensors, lights and plugins are dropped.

    Args:
        sdf: the parsed document, with its includes resolved.
        root: the root element of the document.

    Returns:
        The robot and no findings, or no robot and the reason (SDF180): the document is not a single model, links and
        joints do not form a tree from the canonical link, or there are shapes that URDF does not have.
    """
    report = SdfReport()
    try:
        return Reading(_Converter(_require_single_model(sdf, root)).robot(), ())
    except _NoRobotError as error:
        message = phrase("this SDF cannot be a robot description: {reason}", reason=error.reason)
        report.reject("SDF180", message, error.element or root, hint=error.hint)
    except FrameError as error:
        message = phrase("this SDF cannot be a robot description: there is no frame '{name}'", name=error.name)
        report.reject("SDF180", message, root)
    return Reading(None, report.in_order())


def _require_single_model(sdf: Sdf, root: Element) -> Model:
    if sdf.worlds:
        hint = phrase("give a file with only the <model> of the robot")
        raise _NoRobotError(phrase("it has a world, but a robot description is one model"), sdf.worlds[0].element, hint)
    if len(sdf.models) != 1:
        reason = phrase("it has {count} models, but a robot description is one model", count=len(sdf.models))
        raise _NoRobotError(reason, root)
    return sdf.models[0]


class _Converter:
    def __init__(self, model: Model) -> None:
        self._model = model
        self._frames = Frames(model)

    def robot(self) -> urdf.Robot:
        model = self._model
        if model.pose != AT_ORIGIN:
            hint = phrase("set the pose where it is spawned, or move its links")
            raise _NoRobotError(phrase("the model has a <pose>"), model.element, hint)
        if model.models or model.includes:
            inner = model.models[0].element if model.models else model.includes[0].element
            hint = phrase("include it with merge='true', or write its links into the model")
            raise _NoRobotError(phrase("the model contains another model"), inner, hint)
        if not model.links:
            raise _NoRobotError(phrase("the model has no link"), model.element)
        above = self._parent_joints()
        root = self._frames.link("")
        self._check_tree(root, above)
        joints = [self._joint(joint, above) for joint in model.joints]
        links = {link.name: self._link(link, above.get(link.name)) for link in model.links}
        looks = [visual.material for link in links.values() for visual in link.visuals if visual.material is not None]
        return urdf.Robot(
            model.name,
            root,
            links,
            {joint.name: joint for joint in joints},
            {look.name: look for look in looks},
            element=model.element,
        )

    def _parent_joints(self) -> dict[str, Joint]:
        above: dict[str, Joint] = {}
        for joint in self._model.joints:
            child = self._frames.link(joint.child)
            if WORLD in (child, self._frames.link(joint.parent)):
                reason = phrase("{joint} connects the model with the world", joint=_named(joint))
                raise _NoRobotError(reason, joint.element, phrase("set a fixed base where the robot is spawned"))
            if child in above:
                values = {"link": child, "one": above[child].name, "other": joint.name}
                reason = phrase("link '{link}' is the child of two joints, '{one}' and '{other}'", **values)
                raise _NoRobotError(
                    reason, joint.element, phrase("URDF supports only trees; leave one of the joints out")
                )
            above[child] = joint
        return above

    def _check_tree(self, root: str, above: dict[str, Joint]) -> None:
        if root in above:
            values = {"link": root, "joint": above[root].name}
            reason = phrase("the canonical link '{link}' is the child of joint '{joint}'", **values)
            hint = phrase("name the root link: <model canonical_link='...'>")
            raise _NoRobotError(reason, above[root].element, hint)
        for link in self._model.links:
            chain = {link.name: None}
            name = link.name
            while name in above:
                name = self._frames.link(above[name].parent)
                if name in chain:
                    reason = phrase("link '{link}' is below itself in the tree of joints", link=name)
                    raise _NoRobotError(reason, above[name].element)
                chain[name] = None
            if name != root:
                values = {"link": name, "root": root}
                reason = phrase("link '{link}' has no parent, and neither has '{root}'", **values)
                hint = phrase("connect them with a fixed joint")
                raise _NoRobotError(reason, next(link.element for link in self._model.links if link.name == name), hint)

    def _joint(self, joint: Joint, above: dict[str, Joint]) -> urdf.Joint:
        parent = self._frames.link(joint.parent)
        origin = compose(invert(self._frame(parent, above)), self._frames.pose(joint.name))
        kind = _TYPES.get(joint.type, "floating")
        axis = joint.axis
        moves = axis is not None and kind in ("revolute", "continuous", "prismatic")
        if kind == "revolute" and axis is not None and isinf(axis.limit.lower) and isinf(axis.limit.upper):
            kind = "continuous"
        if not moves and kind in ("revolute", "continuous", "prismatic"):
            raise _NoRobotError(phrase("{joint} has no <axis>", joint=_named(joint)), joint.element)
        return urdf.Joint(
            joint.name,
            kind,
            parent,
            self._frames.link(joint.child),
            pose_of(origin),
            self._frames.axis(joint, axis) if moves and axis is not None else (1.0, 0.0, 0.0),
            _limit(axis) if moves and axis is not None and kind != "continuous" else None,
            _mimic(axis) if moves and axis is not None else None,
            dynamics=urdf.Dynamics(axis.dynamics.damping, axis.dynamics.friction) if moves and axis else None,
            element=joint.element,
        )

    def _frame(self, link: str, above: dict[str, Joint]) -> Transform:
        """Return the pose in the model of a link's frame in URDF: the frame of its parent joint, if any."""
        return self._frames.pose(above[link].name if link in above else link)

    def _link(self, link: Link, above: Joint | None) -> urdf.Link:
        in_joint = IDENTITY
        if above is not None:
            in_joint = compose(invert(self._frames.pose(above.name)), self._frames.pose(link.name))
        return urdf.Link(
            link.name,
            self._inertial(link, in_joint),
            tuple(self._visual(visual, link, in_joint) for visual in link.visuals),
            tuple(self._collision(collision, link, in_joint) for collision in link.collisions),
            link.element,
        )

    def _inertial(self, link: Link, in_joint: Transform) -> urdf.Inertial:
        inertial = link.inertial or Inertial()
        tensor = inertial.inertia
        origin = pose_of(compose(in_joint, self._frames.in_link(inertial.pose, link.name)))
        return urdf.Inertial(
            inertial.mass,
            tensor.ixx,
            tensor.ixy,
            tensor.ixz,
            tensor.iyy,
            tensor.iyz,
            tensor.izz,
            origin,
            inertial.element,
        )

    def _visual(self, visual: Visual, link: Link, in_joint: Transform) -> urdf.Visual:
        look = _material(visual.material, f"{link.name}{visual.name}")
        return urdf.Visual(
            _geometry(visual),
            pose_of(compose(in_joint, self._frames.in_link(visual.pose, link.name))),
            visual.name,
            look.name if look is not None else "",
            look,
            visual.element,
        )

    def _collision(self, collision: Collision, link: Link, in_joint: Transform) -> urdf.Collision:
        origin = pose_of(compose(in_joint, self._frames.in_link(collision.pose, link.name)))
        return urdf.Collision(_geometry(collision), origin, collision.name, collision.element)


def _named(joint: Joint) -> Phrase:
    return described(joint.element) if joint.element is not None else phrase("joint '{name}'", name=joint.name)


def _limit(axis: Axis) -> urdf.Limit:
    limit = axis.limit
    lower, upper = max(limit.lower, -_UNBOUNDED), min(limit.upper, _UNBOUNDED)
    return urdf.Limit(lower, upper, min(limit.effort, _UNBOUNDED), min(limit.velocity, _UNBOUNDED))


def _mimic(axis: Axis) -> urdf.Mimic | None:
    mimic = axis.mimic
    if mimic is None:
        return None
    return urdf.Mimic(mimic.joint, mimic.multiplier, mimic.offset - mimic.multiplier * mimic.reference)


def _geometry(part: Visual | Collision) -> urdf.Geometry:
    shape: Shape = part.geometry
    if isinstance(shape, Mesh):
        return urdf.Mesh(shape.uri, shape.scale)
    if isinstance(shape, Box | Cylinder | Capsule | Sphere):
        return shape
    values = {"shape": term(type(shape).__name__.lower()), "name": part.name}
    reason = phrase("'{name}' has the shape <{shape}>, which URDF does not support", **values)
    raise _NoRobotError(reason, part.element, phrase("use a box, a cylinder, a sphere or a mesh"))


def _material(material: Material | None, name: str) -> urdf.Material | None:
    if material is None or (material.ambient is None and material.diffuse is None):
        return None
    ambient, diffuse = material.ambient or material.diffuse, material.diffuse or material.ambient
    assert ambient is not None
    assert diffuse is not None
    red, green, blue, alpha = (
        min(_AMBIENT * shade + _DIFFUSE * light, 1.0) for shade, light in zip(ambient, diffuse, strict=True)
    )
    return urdf.Material(name, (red, green, blue, alpha))
