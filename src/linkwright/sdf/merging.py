"""Merge ``<include merge="true">`` into the including model (SDF 1.9).

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


def merge_models(enclosing_model: Model, included_model: Model) -> Model:
    """Return a model with the links, joints and other contents of an included model.

    A new frame with the pose of `included_model` replaces its model frame.

    Raises:
        FrameError: the placement frame of `included_model` does not exist.
    """
    frame_name = f"_merged__{included_model.name}__model__"
    pose = included_model.pose
    if included_model.placement_frame:
        placement_transform = Frames(included_model).pose(included_model.placement_frame)
        pose = RawPose(pose_of(compose(transform_of(pose.pose), invert(placement_transform))), pose.relative_to)
    anchor_link = included_model.canonical_link or (included_model.links[0].name if included_model.links else "")
    pose = RawPose(pose.pose, pose.relative_to or MODEL)
    frames = (
        Frame(frame_name, anchor_link, pose),
        *(
            _with_attachment(_with_pose_in_frame(nested_frame, frame_name), frame_name)
            for nested_frame in included_model.frames
        ),
    )
    return replace(
        enclosing_model,
        links=(*enclosing_model.links, *(_with_pose_in_frame(link, frame_name) for link in included_model.links)),
        joints=(
            *enclosing_model.joints,
            *(_with_frame_references(joint, frame_name) for joint in included_model.joints),
        ),
        frames=(*enclosing_model.frames, *frames),
        models=(*enclosing_model.models, *(_with_pose_in_frame(model, frame_name) for model in included_model.models)),
        plugins=(*enclosing_model.plugins, *included_model.plugins),
        includes=(*enclosing_model.includes, *included_model.includes),  # includes that cannot be resolved
    )


def _with_pose_in_frame(posed: _Posed, frame: str) -> _Posed:
    """Return an element with a pose relative to `frame` instead of its model's frame.

    A pose that is relative to another frame is not changed.
    """
    pose = posed.pose
    is_attached = isinstance(posed, Frame) and posed.attached_to != ""
    if pose.relative_to == MODEL or (pose.relative_to == "" and not is_attached):
        return replace(posed, pose=RawPose(pose.pose, frame))
    return posed


def _with_attachment(nested_frame: Frame, frame: str) -> Frame:
    return replace(nested_frame, attached_to=frame) if nested_frame.attached_to in ("", MODEL) else nested_frame


def _with_frame_references(joint: Joint, frame: str) -> Joint:
    """Replace a joint's references to the model's frame by references to `frame`.

    A pose without such a reference remains relative to the joint's child.
    """
    pose = RawPose(joint.pose.pose, frame) if joint.pose.relative_to == MODEL else joint.pose
    return replace(
        joint,
        parent=frame if joint.parent == MODEL else joint.parent,
        child=frame if joint.child == MODEL else joint.child,
        pose=pose,
        axis=_with_axis_frame(joint.axis, frame),
        axis2=_with_axis_frame(joint.axis2, frame),
    )


def _with_axis_frame(axis: Axis | None, frame: str) -> Axis | None:
    """Return an axis that is expressed in `frame` if it was expressed in its model's frame."""
    if axis is None or axis.expressed_in != MODEL:
        return axis
    return replace(axis, expressed_in=frame)
