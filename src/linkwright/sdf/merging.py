"""Merged includes, ``<include merge="true">``, whose parts become parts of a model (SDF 1.9).

Source: the proposal "Merge include" of SDFormat and libsdformat's frame ``_merged__NAME__model__``.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from linkwright.geometry.single import compose, invert
from linkwright.sdf.frames import Frames, pose_of, transform_of
from linkwright.sdf.joints import Axis, Joint
from linkwright.sdf.links import Link
from linkwright.sdf.models import Frame, Model
from linkwright.sdf.poses import MODEL, RawPose

_Posed = TypeVar("_Posed", Link, Frame, Model)


def merged(whole: Model, part: Model) -> Model:
    """Return the model `whole` with the parts of the model `part` added.

    The added parts are placed in a new frame, which has the pose of `part`.

    Raises:
        FrameError: the placement frame of `part` does not exist.
    """
    frame = f"_merged__{part.name}__model__"
    pose = part.pose
    if part.placement_frame:
        inside = Frames(part).pose(part.placement_frame)
        pose = RawPose(pose_of(compose(transform_of(pose.pose), invert(inside))), pose.relative_to)
    anchor = part.canonical_link or (part.links[0].name if part.links else "")
    pose = RawPose(pose.pose, pose.relative_to or MODEL)
    frames = (Frame(frame, anchor, pose), *(_attached(_moved(other, frame), frame) for other in part.frames))
    return replace(
        whole,
        links=(*whole.links, *(_moved(link, frame) for link in part.links)),
        joints=(*whole.joints, *(_connected(joint, frame) for joint in part.joints)),
        frames=(*whole.frames, *frames),
        models=(*whole.models, *(_moved(model, frame) for model in part.models)),
        plugins=(*whole.plugins, *part.plugins),
        includes=(*whole.includes, *part.includes),  # those that cannot be resolved
    )


def _moved(posed: _Posed, frame: str) -> _Posed:
    """Return a part whose pose is relative to `frame` instead of its model's frame.

    A pose that is relative to another frame remains.
    """
    pose = posed.pose
    is_attached = isinstance(posed, Frame) and posed.attached_to != ""
    if pose.relative_to == MODEL or (pose.relative_to == "" and not is_attached):
        return replace(posed, pose=RawPose(pose.pose, frame))
    return posed


def _attached(attached: Frame, frame: str) -> Frame:
    return replace(attached, attached_to=frame) if attached.attached_to in ("", MODEL) else attached


def _connected(joint: Joint, frame: str) -> Joint:
    """Return a joint in which references to the model's frame refer to `frame` instead.

    A pose without such a reference remains relative to the joint's child.
    """
    pose = RawPose(joint.pose.pose, frame) if joint.pose.relative_to == MODEL else joint.pose
    return replace(
        joint,
        parent=frame if joint.parent == MODEL else joint.parent,
        child=frame if joint.child == MODEL else joint.child,
        pose=pose,
        axis=_turned(joint.axis, frame),
        axis2=_turned(joint.axis2, frame),
    )


def _turned(axis: Axis | None, frame: str) -> Axis | None:
    """Return an axis that is expressed in `frame` if it was expressed in its model's frame."""
    if axis is None or axis.expressed_in != MODEL:
        return axis
    return replace(axis, expressed_in=frame)
