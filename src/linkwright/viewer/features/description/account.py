"""Summarizes a description for pages: its links and joints, each with its place in the source."""

from __future__ import annotations

from math import isfinite

import numpy as np

from linkwright.geometry.single import quaternion_of, rpy_from_quaternion
from linkwright.urdf import Joint, Link, Mimic, Robot
from linkwright.viewer.features.description.places import Places
from linkwright.viewer.protocol.description import Description, JointDetails, JointMimic, LinkDetails
from linkwright.viewer.robot import frame_of, link_inertia


def account(robot: Robot, text: str, files: list[str], *, display: str, revision: int, prefix: str) -> Description:
    """Everything about a robot but its shapes, which pages have already.

    Takes as long as reading the text once more does.

    Args:
        robot: read from the text.
        text: the description, expanded.
        files: what it was made from.
        display: the RobotModel display that shows it.
        revision: counts the descriptions of the display.
        prefix: the display's TF Prefix.
    """
    places = Places(text)
    above = {joint.child: joint.name for joint in robot.joints.values()}
    return Description(
        display=display,
        revision=revision,
        name=robot.name,
        root=robot.root,
        links=[_link(link, above.get(link.name), prefix, places) for link in robot.links.values()],
        joints=[_joint(joint, places) for joint in robot.joints.values()],
        files=files,
    )


def _link(link: Link, parent_joint: str | None, prefix: str, places: Places) -> LinkDetails:
    return LinkDetails(
        name=link.name,
        frame=frame_of(link.name, prefix),
        parent_joint=parent_joint,
        inertia=link_inertia(link.inertial),
        written=places.of("link", link.name, link.element),
    )


def _joint(joint: Joint, places: Places) -> JointDetails:
    limit, dynamics, safety = joint.limit, joint.dynamics, joint.safety
    ranged = limit is not None and joint.type in ("revolute", "prismatic")
    quaternion = quaternion_of(joint.origin)
    return JointDetails(
        name=joint.name,
        kind=joint.type,
        parent=joint.parent,
        child=joint.child,
        xyz=[_finite(part) or 0.0 for part in joint.origin.xyz],
        rpy=[_finite(part) or 0.0 for part in rpy_from_quaternion(quaternion)],
        quaternion=[_finite(part) or 0.0 for part in quaternion],
        axis=_unit(joint.axis),
        lower=_finite(limit.lower) if limit and ranged else None,
        upper=_finite(limit.upper) if limit and ranged else None,
        velocity=_finite(limit.velocity) if limit else None,
        effort=_finite(limit.effort) if limit else None,
        damping=_finite(dynamics.damping) if dynamics else None,
        friction=_finite(dynamics.friction) if dynamics else None,
        soft_lower=_finite(safety.soft_lower_limit) if safety else None,
        soft_upper=_finite(safety.soft_upper_limit) if safety else None,
        k_position=_finite(safety.k_position) if safety else None,
        k_velocity=_finite(safety.k_velocity) if safety else None,
        mimic=_mimic(joint.mimic),
        written=places.of("joint", joint.name, joint.element),
    )


def _mimic(mimic: Mimic | None) -> JointMimic | None:
    if mimic is None:
        return None
    return JointMimic(mimic.joint, _finite(mimic.multiplier) or 0.0, _finite(mimic.offset) or 0.0)


def _finite(number: float) -> float | None:
    return float(number) if isfinite(number) else None


def _unit(axis: tuple[float, float, float]) -> list[float]:
    """The axis in length one; zeros for one that is none."""
    length = float(np.linalg.norm(axis))
    if not (isfinite(length) and length > 0):
        return [0.0, 0.0, 0.0]
    return [part / length for part in axis]
