"""Convert a robot from URDF to a model in SDF, as in gz.

Source: libsdformat's parser of URDF and its page "URDF extensions in SDFormat".
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from linkwright.diagnostics import Diagnostic, phrase, quoted_names
from linkwright.geometry.single import Pose, Transform, compose
from linkwright.sdf import shapes
from linkwright.sdf.bodies import Body, Part, find_rigid_bodies
from linkwright.sdf.frames import pose_of, transform_of
from linkwright.sdf.gazebo import Extensions, LinkExtension
from linkwright.sdf.joints import Axis, AxisLimit, AxisMimic, Joint
from linkwright.sdf.lights import Light
from linkwright.sdf.links import Collision, Inertia, Inertial, Link, Visual
from linkwright.sdf.materials import Material, Pbr, Workflow
from linkwright.sdf.models import Frame, Model
from linkwright.sdf.poses import MODEL, WORLD, RawPose
from linkwright.sdf.report import SdfReport
from linkwright.sdf.scripts import find_gazebo_look, with_look
from linkwright.sdf.sensors import Sensor
from linkwright.urdf import Robot
from linkwright.urdf import model as urdf
from linkwright.urdf.bodies import Bodies

_Posed = TypeVar("_Posed", Sensor, Light)

_SDF_JOINT_TYPES = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic", "fixed": "fixed"}
"""The SDF joint type for each URDF type. Other joints are left out, so that their child links move freely."""
_LUMP_SEPARATOR = "_fixed_joint_lump__"
_TINY_INERTIAL = Inertial(1e-6, inertia=Inertia(1e-9, 1e-9, 1e-9))
"""The mass properties of a massless link that is fixed to links with mass. Without them, SDF assumes 1 kg."""
_BRIGHTNESS_FACTOR = 1.25
"""The factor that brightens URDF colors, because gz renders them darker than RViz does."""


@dataclass(frozen=True, slots=True)
class Conversion:
    """An SDF model that was converted from URDF.

    Attributes:
        model: the robot as an SDF model.
        diagnostics: errors in the robot's ``<gazebo>`` elements, and warnings about elements that SDF cannot express.
    """

    model: Model
    diagnostics: tuple[Diagnostic, ...]


def model_from_robot(robot: Robot, *, lump_fixed_joints: bool) -> Conversion:
    """Convert a robot to an SDF model, as gz does.

    A root link called ``world`` represents the world. The addresses of meshes are not changed.

    Args:
        robot: the robot to convert.
        lump_fixed_joints: whether to merge links that are connected by fixed joints, which is the default in gz. If
            True, merged links become frames, and links without a mass are left out. If False, all links and fixed
            joints are kept.
    """
    report = SdfReport()
    extensions = Extensions(robot, report)
    converter = _Converter(robot, extensions, report, lump_fixed_joints=lump_fixed_joints)
    return Conversion(converter.model(), report.in_order())


class _Converter:
    def __init__(self, robot: Robot, extensions: Extensions, report: SdfReport, *, lump_fixed_joints: bool) -> None:
        self._robot = robot
        self._extensions = extensions
        self._report = report
        self._is_lumping = lump_fixed_joints
        self._rigid_bodies = Bodies(robot)

    def model(self) -> Model:
        bodies = find_rigid_bodies(self._robot, self._is_lumped)
        if self._is_lumping:
            bodies = self._remove_massless(bodies)
        parts = [part for body in bodies for part in body.parts]
        extensions = {part.link.name: self._extensions.link(part.link) for part in parts}
        joints = [self._convert_joint(body, body.joint) for body in bodies if body.joint is not None]
        self._report_default_mass(bodies)
        model_extension = self._extensions.model(self._robot)
        return replace(
            model_extension,
            name=self._robot.name,
            links=(*(self._convert_link(body, extensions) for body in bodies), *model_extension.links),
            joints=(*(joint for joint in joints if joint is not None), *model_extension.joints),
            frames=(*(frame for body in bodies for frame in self._convert_frames(body)), *model_extension.frames),
            element=self._robot.element,
        )

    def _is_lumped(self, joint: urdf.Joint) -> bool:
        return (
            self._is_lumping
            and joint.type == "fixed"
            and not self._extensions.stays_fixed(joint)
            and not self._extensions.becomes_revolute(joint)
        )

    def _remove_massless(self, bodies: list[Body]) -> list[Body]:
        """Return the bodies that have mass, and report the bodies without mass.

        As in gz, descendants of massless bodies are also left out.
        """
        left_out: set[str] = set()
        bodies_with_mass = []
        for body in bodies:
            if body.parent in left_out:
                left_out.add(body.name)
            elif sum(part.link.inertial.mass for part in body.parts if part.link.inertial) > 0:
                bodies_with_mass.append(body)
            else:
                left_out.add(body.name)
                self._report_massless(body)
        return bodies_with_mass

    def _report_massless(self, body: Body) -> None:
        element = body.parts[0].link.element
        if element is None:
            return
        message = phrase("link '{name}' has no mass, so it is left out", name=body.name)
        if body.children:
            message = phrase("link '{name}' has no mass, so it is left out with all links below it", name=body.name)
        self._report.warning("SDF170", message, element, hint=phrase("give it an <inertial> with a mass"))

    def _report_default_mass(self, bodies: list[Body]) -> None:
        """Report links without mass that can move: SDF gives them 1 kg, whereas gz leaves them out."""
        if self._is_lumping:
            return
        links = [body.parts[0].link for body in bodies if body.joint is None or body.joint.type != "fixed"]
        massless_links = [link for link in links if link.inertial is None and self._inertial_for_massless(link) is None]
        element = next((link.element for link in massless_links if link.element is not None), None)
        if element is not None:
            message = phrase(
                "links without a mass have SDF's default mass of 1 kg, but gz leaves them out: {names}",
                names=quoted_names(link.name for link in massless_links),
            )
            hint = phrase("give each link an <inertial>, which `linkwright inertia` computes")
            self._report.warning("SDF172", message, element, hint=hint)

    def _convert_link(self, body: Body, extensions: dict[str, LinkExtension]) -> Link:
        extension = extensions[body.name].link
        link = body.parts[0].link
        merged_extensions = [extensions[part.link.name].link for part in body.parts[1:]]
        merged_poses = [part.pose for part in body.parts[1:]]
        sensors = [
            _move_to_body_frame(sensor, pose)
            for merged_extension, pose in zip(merged_extensions, merged_poses, strict=True)
            for sensor in merged_extension.sensors
        ]
        lights = [
            _move_to_body_frame(light, pose)
            for merged_extension, pose in zip(merged_extensions, merged_poses, strict=True)
            for light in merged_extension.lights
        ]
        return replace(
            extension,
            pose=self._convert_pose(body),
            inertial=_combine_inertials(body.parts) or self._inertial_for_massless(link),
            visuals=(*_convert_visuals(body, extensions), *extension.visuals),
            collisions=(*_convert_collisions(body, extensions), *extension.collisions),
            sensors=(*extension.sensors, *sensors),
            lights=(*extension.lights, *lights),
            gravity=extension.gravity and all(merged_extension.gravity for merged_extension in merged_extensions),
            self_collide=next(
                (link.self_collide for link in (extension, *merged_extensions) if link.self_collide is not None), None
            ),
            element=link.element,
        )

    def _inertial_for_massless(self, link: urdf.Link) -> Inertial | None:
        """Return a tiny inertial if links are not lumped and the link is fixed to links with mass.

        Otherwise return None.
        """
        rigid_body = self._rigid_bodies.of(link.name)
        return (
            _TINY_INERTIAL
            if not self._is_lumping and rigid_body is not None and self._rigid_bodies.mass(rigid_body) > 0
            else None
        )

    def _convert_pose(self, body: Body) -> RawPose:
        """Return the pose of a body's link, in the frame of its joint or in its parent link.

        In the frame of its joint, the pose is zero.
        """
        if body.joint is None:
            return RawPose()
        if body.joint.type in _SDF_JOINT_TYPES and body.joint.name not in self._robot.links:
            return RawPose(relative_to=body.joint.name)
        return _compute_pose_in_parent(body)

    def _convert_joint(self, body: Body, joint: urdf.Joint) -> Joint | None:
        if joint.type not in _SDF_JOINT_TYPES:
            if joint.type == "planar" and joint.element is not None:
                message = phrase(
                    "joint '{name}' is left out, because SDF does not support planar joints", name=joint.name
                )
                hint = phrase("use two prismatic joints and a continuous joint instead")
                self._report.warning("SDF171", message, joint.element, hint=hint)
            return None
        extension = self._extensions.joint(joint, self._robot)
        kind, axis = _SDF_JOINT_TYPES[joint.type], None
        if kind != "fixed":
            axis = _convert_axis(joint, extension.axis or Axis())
        elif self._is_lumping and self._extensions.becomes_revolute(joint):
            kind, axis = "revolute", Axis(limit=AxisLimit(0.0, 0.0))
        if joint.name in self._robot.links and joint.element is not None:
            message = phrase("joint '{name}' has the same name as a link, which SDF does not allow", name=joint.name)
            self._report.warning(
                "SDF171", message, joint.element, "name", hint=phrase("give each of them a different name")
            )
        return replace(
            extension,
            type=kind,
            parent=body.parent,
            child=body.name,
            pose=_compute_pose_in_parent(body),
            axis=axis,
            element=joint.element,
        )

    def _convert_frames(self, body: Body) -> Iterator[Frame]:
        """Yield the frames that represent the lumped links of a body and their joints."""
        for part in body.parts[1:]:
            joint, link = part.joint, part.link
            assert joint is not None
            self._report_sensors(joint)
            if joint.name in self._robot.links:
                yield Frame(link.name, joint.parent, RawPose(joint.origin), link.element)
            else:
                yield Frame(joint.name, joint.parent, RawPose(joint.origin), joint.element)
                yield Frame(link.name, joint.name, element=link.element)

    def _report_sensors(self, joint: urdf.Joint) -> None:
        for sensor in self._extensions.joint(joint, self._robot).sensors:
            if sensor.element is not None:
                message = phrase(
                    "sensor '{name}' is left out, because the links of joint '{joint}' are merged",
                    name=sensor.name,
                    joint=joint.name,
                )
                hint = phrase(
                    'keep the joint: <gazebo reference="{name}"><preserveFixedJoint>true</preserveFixedJoint></gazebo>',
                    name=joint.name,
                )
                self._report.warning("SDF171", message, sensor.element, hint=hint)


def _compute_pose_in_parent(body: Body) -> RawPose:
    return RawPose(body.pose, MODEL if body.parent == WORLD else body.parent)


def _move_to_body_frame(posed: _Posed, pose: Transform) -> _Posed:
    """Return a sensor or light with its pose converted from its link to the link's body.

    A pose relative to a named frame is not changed.
    """
    if posed.pose.relative_to:
        return posed
    return replace(posed, pose=RawPose(pose_of(compose(pose, transform_of(posed.pose.pose)))))


def _convert_to_body_frame(pose: Pose, part: Part) -> RawPose:
    """Convert a pose from the frame of a part to the frame of the body that contains it."""
    return RawPose(pose if part.joint is None else pose_of(compose(part.pose, transform_of(pose))))


def _combine_inertials(parts: Sequence[Part]) -> Inertial | None:
    first = parts[0].link.inertial
    if any(part.link.inertial for part in parts[1:]):
        from linkwright.sdf.lumping import lump_inertials  # delays the import of numpy

        return lump_inertials(parts)
    if first is None:
        return None
    tensor = Inertia(first.ixx, first.iyy, first.izz, first.ixy, first.ixz, first.iyz)
    return Inertial(first.mass, RawPose(first.origin), tensor, element=first.element)


def _convert_visuals(body: Body, extensions: Mapping[str, LinkExtension]) -> Iterator[Visual]:
    visuals = ((part, visual) for part in body.parts for visual in part.link.visuals)
    for index, (part, visual) in enumerate(visuals):
        extension = extensions[part.link.name].visual
        yield replace(
            extension,
            name=_make_shape_name(body, part, visual.name, "visual", index),
            geometry=_convert_shape(visual.geometry),
            pose=_convert_to_body_frame(visual.origin, part),
            material=_convert_material(visual.material, extension.material),
            element=visual.element,
        )


def _convert_collisions(body: Body, extensions: Mapping[str, LinkExtension]) -> Iterator[Collision]:
    collisions = ((part, collision) for part in body.parts for collision in part.link.collisions)
    for index, (part, collision) in enumerate(collisions):
        yield replace(
            extensions[part.link.name].collision,
            name=_make_shape_name(body, part, collision.name, "collision", index),
            geometry=_convert_shape(collision.geometry),
            pose=_convert_to_body_frame(collision.origin, part),
            element=collision.element,
        )


def _make_shape_name(body: Body, part: Part, shape_name: str, kind: str, count: int) -> str:
    """Return the name of a visual or collision, as libsdformat forms it.

    Examples are ``wheel_visual``, ``wheel_visual_1`` and ``base_fixed_joint_lump__camera_visual_2``.
    """
    name = f"{shape_name or part.link.name}_{kind}"
    if count:
        name = f"{name}_{count}"
    return name if name.startswith(body.name) else f"{body.name}{_LUMP_SEPARATOR}{name}"


def _convert_shape(geometry: urdf.Geometry) -> shapes.Shape:
    if isinstance(geometry, urdf.Mesh):
        return shapes.Mesh(geometry.filename, geometry.scale)
    return geometry


def _convert_material(urdf_material: urdf.Material | None, extension: Material | None) -> Material | None:
    """Return the material of a visual, or None if there is none.

    The colors and scripts of ``<gazebo>`` take precedence over the URDF material.
    """
    if (
        extension is not None
        and extension.script is not None
        and (look := find_gazebo_look(extension.script.name)) is not None
    ):
        return with_look(extension, look)
    if urdf_material is None or (extension is not None and (extension.diffuse or extension.ambient)):
        return extension
    sdf_material = extension or Material()
    if urdf_material.rgba is not None:
        red, green, blue, alpha = urdf_material.rgba
        color = (_brighten(red), _brighten(green), _brighten(blue), alpha)
        sdf_material = replace(sdf_material, ambient=color, diffuse=color)
    if urdf_material.texture is not None and sdf_material.pbr is None:
        sdf_material = replace(sdf_material, pbr=Pbr(metal=Workflow(albedo_map=urdf_material.texture)))
    return sdf_material


def _brighten(component: float) -> float:
    return min(max(component * _BRIGHTNESS_FACTOR, 0.0), 1.0)


def _convert_axis(joint: urdf.Joint, extension: Axis) -> Axis:
    """Return the axis of a joint, with the spring that its ``<gazebo>`` element sets."""
    limit, dynamics, mimic = AxisLimit(), extension.dynamics, None
    if joint.limit is not None:
        limit = AxisLimit(effort=joint.limit.effort, velocity=joint.limit.velocity)
        if joint.type != "continuous":
            low, high = sorted((joint.limit.lower, joint.limit.upper))
            limit = replace(limit, lower=low, upper=high)
    if joint.dynamics is not None:
        dynamics = replace(dynamics, damping=joint.dynamics.damping, friction=joint.dynamics.friction)
    if joint.mimic is not None:
        mimic = AxisMimic(joint.mimic.joint, multiplier=joint.mimic.multiplier, offset=joint.mimic.offset)
    return replace(extension, xyz=joint.axis, limit=limit, dynamics=dynamics, mimic=mimic)
