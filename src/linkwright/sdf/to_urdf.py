"""Convert a model in SDF to a robot in URDF, as in ROS.

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
from linkwright.sdf.report import SdfReport, describe_element
from linkwright.sdf.shapes import Mesh, Shape
from linkwright.sdf.worlds import Sdf
from linkwright.urdf import Reading
from linkwright.urdf import model as urdf
from linkwright.xmltree import Element

_URDF_JOINT_TYPES: dict[str, urdf.JointType] = {
    "revolute": "revolute",
    "hinge": "revolute",
    "continuous": "continuous",
    "prismatic": "prismatic",
    "fixed": "fixed",
}
"""The URDF joint type for each SDF type. Joints of any other type become floating joints."""
_UNBOUNDED = 1e16
"""The number that SDF uses for an unbounded limit.

It is also written to URDF, which cannot express an unbounded limit.
"""
_AMBIENT_INTENSITY, _DIFFUSE_INTENSITY = 0.4, 0.8
"""The intensities of the light in a default Gazebo world, from which sdformat_urdf computes one color."""


class _ConversionError(Exception):
    """Raised when a model cannot be converted to a robot.

    The exception contains the reason, the element to report and a hint.
    """

    def __init__(self, reason: Phrase, element: Element | None, hint: Phrase | None = None) -> None:
        super().__init__(reason)
        self.reason = reason
        self.element = element
        self.hint = hint


def robot_from_sdf(sdf: Sdf, root: Element) -> Reading:
    """Convert the model of an SDF document to a robot.

    In URDF, the frame of a link is the frame of its parent joint, so the poses in the link are converted. Addresses of
    meshes are not changed. Sensors, lights and plugins are left out.

    Args:
        sdf: the content of the document, with its includes resolved.
        root: the root element of the document.

    Returns:
        The robot without findings, or no robot and a finding (SDF180) if the document is not a single model, if links
        and joints do not form a tree from the canonical link, or if URDF does not support a shape.
    """
    report = SdfReport()
    try:
        return Reading(_Converter(_require_single_model(sdf, root)).robot(), ())
    except _ConversionError as error:
        message = phrase("this SDF cannot be a robot description: {reason}", reason=error.reason)
        report.reject("SDF180", message, error.element or root, hint=error.hint)
    except FrameError as error:
        message = phrase("this SDF cannot be a robot description: there is no frame '{name}'", name=error.name)
        report.reject("SDF180", message, root)
    return Reading(None, report.in_order())


def _require_single_model(sdf: Sdf, root: Element) -> Model:
    if sdf.worlds:
        hint = phrase("use a file that contains only the <model> of the robot")
        raise _ConversionError(
            phrase("it contains a world, but a robot description is one model"), sdf.worlds[0].element, hint
        )
    if len(sdf.models) != 1:
        reason = phrase("it contains {count} models, but a robot description is one model", count=len(sdf.models))
        raise _ConversionError(reason, root)
    return sdf.models[0]


class _Converter:
    def __init__(self, model: Model) -> None:
        self._model = model
        self._frames = Frames(model)

    def robot(self) -> urdf.Robot:
        model = self._model
        if model.pose != AT_ORIGIN:
            hint = phrase("set the pose where the robot is spawned, or move the links of the model")
            raise _ConversionError(phrase("the model has a <pose>, which URDF does not support"), model.element, hint)
        if model.models or model.includes:
            nested_element = model.models[0].element if model.models else model.includes[0].element
            hint = phrase("include it with merge='true', or write its links into the model")
            raise _ConversionError(phrase("the model contains another model"), nested_element, hint)
        if not model.links:
            raise _ConversionError(phrase("the model has no link"), model.element)
        parent_joints = self._index_parent_joints()
        root = self._frames.link("")
        self._check_tree(root, parent_joints)
        joints = [self._convert_joint(joint, parent_joints) for joint in model.joints]
        links = {link.name: self._convert_link(link, parent_joints.get(link.name)) for link in model.links}
        materials = [
            visual.material for link in links.values() for visual in link.visuals if visual.material is not None
        ]
        return urdf.Robot(
            model.name,
            root,
            links,
            {joint.name: joint for joint in joints},
            {material.name: material for material in materials},
            element=model.element,
        )

    def _index_parent_joints(self) -> dict[str, Joint]:
        parent_joints: dict[str, Joint] = {}
        for joint in self._model.joints:
            child = self._frames.link(joint.child)
            if WORLD in (child, self._frames.link(joint.parent)):
                reason = phrase("{joint} connects the model to the world", joint=_describe_joint(joint))
                raise _ConversionError(
                    reason, joint.element, phrase("remove the joint, and spawn the robot with a fixed base")
                )
            if child in parent_joints:
                placeholders = {"link": child, "joint": parent_joints[child].name, "other_joint": joint.name}
                reason = phrase(
                    "link '{link}' is the child of two joints, '{joint}' and '{other_joint}'", **placeholders
                )
                raise _ConversionError(
                    reason, joint.element, phrase("remove one of the joints: URDF supports only trees")
                )
            parent_joints[child] = joint
        return parent_joints

    def _check_tree(self, root: str, parent_joints: dict[str, Joint]) -> None:
        if root in parent_joints:
            placeholders = {"link": root, "joint": parent_joints[root].name}
            reason = phrase("the canonical link '{link}' is the child of joint '{joint}'", **placeholders)
            hint = phrase("set the root link of the tree: <model canonical_link='...'>")
            raise _ConversionError(reason, parent_joints[root].element, hint)
        for link in self._model.links:
            chain = {link.name: None}
            name = link.name
            while name in parent_joints:
                name = self._frames.link(parent_joints[name].parent)
                if name in chain:
                    reason = phrase("link '{link}' is its own descendant in the tree of joints", link=name)
                    raise _ConversionError(reason, parent_joints[name].element)
                chain[name] = None
            if name != root:
                placeholders = {"link": name, "root": root}
                reason = phrase("neither link '{link}' nor the root link '{root}' has a parent", **placeholders)
                hint = phrase("connect them with a fixed joint")
                raise _ConversionError(
                    reason, next(link.element for link in self._model.links if link.name == name), hint
                )

    def _convert_joint(self, joint: Joint, parent_joints: dict[str, Joint]) -> urdf.Joint:
        parent = self._frames.link(joint.parent)
        origin = compose(invert(self._frame(parent, parent_joints)), self._frames.pose(joint.name))
        kind = _URDF_JOINT_TYPES.get(joint.type, "floating")
        axis = joint.axis
        has_axis = axis is not None and kind in ("revolute", "continuous", "prismatic")
        if kind == "revolute" and axis is not None and isinf(axis.limit.lower) and isinf(axis.limit.upper):
            kind = "continuous"
        if not has_axis and kind in ("revolute", "continuous", "prismatic"):
            raise _ConversionError(phrase("{joint} has no <axis>", joint=_describe_joint(joint)), joint.element)
        return urdf.Joint(
            joint.name,
            kind,
            parent,
            self._frames.link(joint.child),
            pose_of(origin),
            self._frames.axis(joint, axis) if has_axis and axis is not None else (1.0, 0.0, 0.0),
            _limit(axis) if has_axis and axis is not None and kind != "continuous" else None,
            _mimic(axis) if has_axis and axis is not None else None,
            dynamics=urdf.Dynamics(axis.dynamics.damping, axis.dynamics.friction) if has_axis and axis else None,
            element=joint.element,
        )

    def _frame(self, link: str, parent_joints: dict[str, Joint]) -> Transform:
        """Return the pose of a link's URDF frame in the model.

        The URDF frame of a link is the frame of the parent joint or, for the root link, the frame of the link.
        """
        return self._frames.pose(parent_joints[link].name if link in parent_joints else link)

    def _convert_link(self, link: Link, parent_joint: Joint | None) -> urdf.Link:
        pose_in_joint = IDENTITY
        if parent_joint is not None:
            pose_in_joint = compose(invert(self._frames.pose(parent_joint.name)), self._frames.pose(link.name))
        return urdf.Link(
            link.name,
            self._inertial(link, pose_in_joint),
            tuple(self._visual(visual, link, pose_in_joint) for visual in link.visuals),
            tuple(self._collision(collision, link, pose_in_joint) for collision in link.collisions),
            link.element,
        )

    def _inertial(self, link: Link, pose_in_joint: Transform) -> urdf.Inertial:
        inertial = link.inertial or Inertial()
        tensor = inertial.inertia
        origin = pose_of(compose(pose_in_joint, self._frames.in_link(inertial.pose, link.name)))
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

    def _visual(self, visual: Visual, link: Link, pose_in_joint: Transform) -> urdf.Visual:
        material = _material(visual.material, f"{link.name}{visual.name}")
        return urdf.Visual(
            _geometry(visual),
            pose_of(compose(pose_in_joint, self._frames.in_link(visual.pose, link.name))),
            visual.name,
            material.name if material is not None else "",
            material,
            visual.element,
        )

    def _collision(self, collision: Collision, link: Link, pose_in_joint: Transform) -> urdf.Collision:
        origin = pose_of(compose(pose_in_joint, self._frames.in_link(collision.pose, link.name)))
        return urdf.Collision(_geometry(collision), origin, collision.name, collision.element)


def _describe_joint(joint: Joint) -> Phrase:
    return describe_element(joint.element) if joint.element is not None else phrase("joint '{name}'", name=joint.name)


def _limit(axis: Axis) -> urdf.Limit:
    limit = axis.limit
    lower, upper = max(limit.lower, -_UNBOUNDED), min(limit.upper, _UNBOUNDED)
    return urdf.Limit(lower, upper, min(limit.effort, _UNBOUNDED), min(limit.velocity, _UNBOUNDED))


def _mimic(axis: Axis) -> urdf.Mimic | None:
    mimic = axis.mimic
    if mimic is None:
        return None
    return urdf.Mimic(mimic.joint, mimic.multiplier, mimic.offset - mimic.multiplier * mimic.reference)


def _geometry(shape_element: Visual | Collision) -> urdf.Geometry:
    shape: Shape = shape_element.geometry
    if isinstance(shape, Mesh):
        return urdf.Mesh(shape.uri, shape.scale)
    if isinstance(shape, Box | Cylinder | Capsule | Sphere):
        return shape
    placeholders = {"shape": term(type(shape).__name__.lower()), "name": shape_element.name}
    reason = phrase("'{name}' has the shape <{shape}>, which URDF does not support", **placeholders)
    raise _ConversionError(reason, shape_element.element, phrase("use a box, a cylinder, a sphere or a mesh"))


def _material(material: Material | None, name: str) -> urdf.Material | None:
    if material is None or (material.ambient is None and material.diffuse is None):
        return None
    ambient, diffuse = material.ambient or material.diffuse, material.diffuse or material.ambient
    assert ambient is not None
    assert diffuse is not None
    red, green, blue, alpha = (
        min(_AMBIENT_INTENSITY * ambient_component + _DIFFUSE_INTENSITY * diffuse_component, 1.0)
        for ambient_component, diffuse_component in zip(ambient, diffuse, strict=True)
    )
    return urdf.Material(name, (red, green, blue, alpha))
