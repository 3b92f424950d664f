"""The element ``<pose>``: a pose as written, with its reference frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.geometry.single import IDENTITY_POSE, Pose
from linkwright.schema import UNREADABLE, AttributeRule, ElementRule, Report
from linkwright.sdf.values import POSE as POSE_NUMBERS
from linkwright.sdf.values import TEXT, TRUTH, choice, never_written, pose_of
from linkwright.xmltree import Element

WORLD = "world"
"""The name of the world's frame in poses and joints."""
MODEL = "__model__"
"""The name of the enclosing model's frame in poses and joints."""
SEPARATOR = "::"
"""The separator between the name of a model and the name of an element in it."""


@dataclass(frozen=True, slots=True)
class RawPose:
    """A pose as written in the file.

    `linkwright.sdf.frames` computes the pose in the model or world.

    Attributes:
        pose: the pose in the frame named by `relative_to`.
        relative_to: the name of a frame, link, joint or model. If empty, the pose of a joint is relative to its child
            link, the pose of a frame to its `attached_to`, and any other pose to the enclosing element.
    """

    pose: Pose = IDENTITY_POSE
    relative_to: str = ""


AT_ORIGIN = RawPose()


def _values_as_dict(**values: Any) -> dict[str, Any]:
    return values


def _read(values: dict[str, Any], element: Element, owner: Element, report: Report) -> Any:
    try:
        pose = pose_of(values["numbers"], values["degrees"], values["rotation_format"])
    except ValueError:
        assert POSE.text is not None
        report.malformed(element, POSE, POSE.text, owner)
        return UNREADABLE
    return RawPose(pose, values["relative_to"] or values["frame"])


POSE = ElementRule(
    "pose",
    "the pose: x y z in meters, roll pitch yaw about the fixed axes in radians",
    (
        AttributeRule(
            "relative_to",
            TEXT,
            "the frame, link, joint or model in which the pose is given",
            default="",
        ),
        AttributeRule("frame", TEXT, "the older name of relative_to, before SDF 1.7", default="", get=never_written),
        AttributeRule("degrees", TRUTH, "whether the angles are in degrees", default="false", get=never_written),
        AttributeRule(
            "rotation_format",
            choice("euler_rpy", "quat_xyzw"),
            "quat_xyzw if a quaternion x y z w replaces the angles",
            default="euler_rpy",
            get=lambda raw: "euler_rpy" if raw.pose.quaternion is None else "quat_xyzw",
        ),
    ),
    text=AttributeRule(
        "text",
        POSE_NUMBERS,
        "the pose",
        default="0 0 0 0 0 0",
        usually_written=True,
        field="numbers",
        get=lambda raw: (*raw.pose.xyz, *(raw.pose.quaternion or raw.pose.rpy)),
    ),
    make=_values_as_dict,
    check=_read,
    default=AT_ORIGIN,
)
