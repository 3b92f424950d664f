"""The element ``<joint>`` and its axes.

Source of the elements and defaults: the SDFormat specification 1.12, ``joint.sdf``; for the tags of older versions
libsdformat's conversions.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf
from typing import Any

from linkwright.geometry.single import Vector3
from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.poses import AT_ORIGIN, MODEL, POSE, RawPose
from linkwright.sdf.sensors import SENSOR, Sensor
from linkwright.sdf.values import NUMBER, TEXT, TRUTH, VECTOR3, choice, name_of, never_written, object_rule, value
from linkwright.xmltree import Element

JOINT_TYPES = (
    "revolute",
    "hinge",
    "gearbox",
    "revolute2",
    "prismatic",
    "ball",
    "screw",
    "universal",
    "fixed",
    "continuous",
    "piston",
)


@dataclass(frozen=True, slots=True)
class AxisLimit:
    """Limits of an axis: positions in rad or m, effort in N m or N, velocity in rad/s or m/s.

    A value without a limit is infinite.
    """

    lower: float = -inf
    upper: float = inf
    effort: float = inf
    velocity: float = inf
    stiffness: float = 1e8
    dissipation: float = 1.0


@dataclass(frozen=True, slots=True)
class AxisDynamics:
    """The damping of an axis in N m s/rad or N s/m, its friction in N m or N, and its spring.

    The spring, with a stiffness in N m/rad or N/m, pulls the joint towards `spring_reference` in rad or m.
    """

    damping: float = 0.0
    friction: float = 0.0
    spring_reference: float = 0.0
    spring_stiffness: float = 0.0


@dataclass(frozen=True, slots=True)
class AxisMimic:
    """A relation that makes an axis follow another joint (SDF 1.11).

    The position, in rad or m, is multiplier * (position of `joint` - reference) + offset.
    """

    joint: str
    axis: str = "axis"
    multiplier: float = 1.0
    offset: float = 0.0
    reference: float = 0.0


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis of a joint.

    Attributes:
        xyz: the direction of the axis in the frame `expressed_in`.
        expressed_in: the name of a frame; empty for the frame of the joint.
        initial_position: the initial position in rad or m, which SDF had before 1.9.
    """

    xyz: Vector3 = (0.0, 0.0, 1.0)
    expressed_in: str = ""
    limit: AxisLimit = AxisLimit()
    dynamics: AxisDynamics = AxisDynamics()
    mimic: AxisMimic | None = None
    initial_position: float = 0.0


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint that connects two links.

    Attributes:
        type: one of `JOINT_TYPES`.
        parent: the name of the parent link or frame; ``world`` for the world.
        child: the name of the child link or frame.
        pose: the pose of the joint, in the frame of its child unless it names another frame.
        axis: the first axis; None for a joint without axes.
        axis2: the second axis; None if the joint type has fewer than two axes.
        thread_pitch: for a screw joint, in meters per revolution (``screw_thread_pitch``); None if not given.
        gearbox_ratio: for a gearbox, the revolutions of the child, in the opposite direction, per revolution of the
            parent.
        gearbox_reference_body: for a gearbox, the link relative to which parent and child rotate.
        sensors: the force-torque sensors of the joint.
    """

    name: str
    type: str
    parent: str
    child: str
    pose: RawPose = AT_ORIGIN
    axis: Axis | None = None
    axis2: Axis | None = None
    thread_pitch: float | None = None
    gearbox_ratio: float = 1.0
    gearbox_reference_body: str = ""
    provide_feedback: bool = False
    sensors: tuple[Sensor, ...] = ()
    element: Element | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class _Physics:
    provide_feedback: bool
    ode: _Physics | None = None


def _make_axis(xyz: tuple[Vector3, str] | None, use_parent_model_frame: bool, **options: Any) -> Axis:
    direction, expressed_in = xyz or ((0.0, 0.0, 1.0), "")
    return Axis(direction, expressed_in or (MODEL if use_parent_model_frame else ""), **options)


def _direction_with_frame(axis: Vector3, expressed_in: str) -> tuple[Vector3, str]:
    return axis, expressed_in


def _limit(lower: float, upper: float, effort: float, velocity: float, **stop_parameters: float) -> AxisLimit:
    """Return axis limits, with infinite numbers for unlimited values.

    Positions of at least 1e16, and negative efforts and velocities, mean that there is no limit.
    """
    return AxisLimit(
        -inf if lower <= -1e16 else lower,
        inf if upper >= 1e16 else upper,
        inf if effort < 0 else effort,
        inf if velocity < 0 else velocity,
        **stop_parameters,
    )


def _joint(
    screw_thread_pitch: float | None, thread_pitch: float | None, physics: _Physics | None, **parts: Any
) -> Joint:
    if screw_thread_pitch is None and thread_pitch is not None:
        # The older tag <thread_pitch> is in radians per meter, with the opposite sign.
        screw_thread_pitch = -6.283185307179586 / thread_pitch if thread_pitch else None
    is_force_measured = physics is not None and (
        physics.provide_feedback or bool(physics.ode and physics.ode.provide_feedback)
    )
    return Joint(thread_pitch=screw_thread_pitch, provide_feedback=is_force_measured, **parts)


def _make_axis_rule(tag: str, meaning: str) -> ElementRule:
    return object_rule(
        _make_axis,
        tag,
        meaning,
        ElementRule(
            "xyz",
            "the direction of the axis",
            (
                AttributeRule(
                    "expressed_in", TEXT, "the frame of the direction; by default that of the joint", default=""
                ),
            ),
            text=AttributeRule(
                "text",
                VECTOR3,
                "the direction, a unit vector",
                default="0 0 1",
                usually_written=True,
                field="axis",
                get=lambda axis: axis.xyz,
            ),
            make=_direction_with_frame,
            get=lambda axis: axis,
        ),
        value(
            "use_parent_model_frame",
            TRUTH,
            "whether the direction is in the frame of the model, up to SDF 1.6",
            default="false",
            get=never_written,
        ),
        value("initial_position", NUMBER, "the initial position", "rad or m", default="0"),
        object_rule(
            _limit,
            "limit",
            "the limits of motion",
            value("lower", NUMBER, "the minimum position", "rad or m", default="-inf"),
            value("upper", NUMBER, "the maximum position", "rad or m", default="inf"),
            value("effort", NUMBER, "the maximum torque or force; negative for no limit", "N m or N", default="inf"),
            value("velocity", NUMBER, "the maximum speed; negative for no limit", "rad/s or m/s", default="inf"),
            value("stiffness", NUMBER, "the stiffness of the stop", default="1e8"),
            value("dissipation", NUMBER, "the damping of the stop", default="1"),
            default=AxisLimit(),
        ),
        object_rule(
            AxisDynamics,
            "dynamics",
            "the damping, friction and spring of the axis",
            value("damping", NUMBER, "the viscous damping", "N m s/rad or N s/m", default="0"),
            value("friction", NUMBER, "the static friction", "N m or N", default="0"),
            value("spring_reference", NUMBER, "the rest position of the spring", "rad or m", default="0"),
            value("spring_stiffness", NUMBER, "the stiffness of the spring", "N m/rad or N/m", default="0"),
            default=AxisDynamics(),
        ),
        ElementRule(
            "mimic",
            "a relation that makes the axis follow another joint",
            (
                AttributeRule("joint", TEXT, "the joint to follow", required=True),
                AttributeRule("axis", TEXT, "the axis of that joint", default="axis"),
            ),
            (
                value("multiplier", NUMBER, "the factor for the position of that joint", default="1"),
                value("offset", NUMBER, "the value that is added to the result", "rad or m", default="0"),
                value("reference", NUMBER, "the value that is subtracted first", "rad or m", default="0"),
            ),
            make=AxisMimic,
        ),
    )


JOINT = ElementRule(
    "joint",
    "a joint that connects two links",
    (
        name_of(),
        AttributeRule("type", choice(*JOINT_TYPES), "the type of motion", required=True, default="fixed"),
    ),
    (
        POSE,
        value("parent", TEXT, "the parent link or frame, or world", default="", required=True),
        value("child", TEXT, "the child link or frame", default="", required=True),
        _make_axis_rule("axis", "the axis of motion"),
        _make_axis_rule("axis2", "the second axis of motion"),
        value(
            "screw_thread_pitch",
            NUMBER,
            "the pitch of a screw, in meters per revolution",
            "m",
            get=lambda joint: joint.thread_pitch,
        ),
        value(
            "thread_pitch",
            NUMBER,
            "the older, inverse pitch of a screw, with the opposite sign",
            "rad/m",
            get=never_written,
        ),
        value(
            "gearbox_ratio",
            NUMBER,
            "the revolutions of a gearbox's child, in the opposite direction, per revolution of its parent",
            default="1",
        ),
        value("gearbox_reference_body", TEXT, "the link relative to which both sides of a gearbox rotate", default=""),
        object_rule(
            _Physics,
            "physics",
            "parameters of physics engines",
            value("provide_feedback", TRUTH, "whether forces in the joint are measured", default="false"),
            object_rule(
                _Physics,
                "ode",
                "parameters of the physics engine ODE",
                value("provide_feedback", TRUTH, "whether forces in the joint are measured", default="false"),
            ),
            get=lambda joint: _Physics(joint.provide_feedback) if joint.provide_feedback else None,
        ),
        SENSOR,
    ),
    is_repeated=True,
    make=_joint,
    keeps_element=True,
    passes_element=True,
    is_owner=True,
    field="joints",
)
