"""Find parameter files of MoveIt that only follow a robot which has lost or renamed joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from linkwright.review.breaking import joint_name_reason
from linkwright.review.changes import Change, Effect, Subject, SubjectKind
from linkwright.review.files.parameters.moveit_names import make_uncontrolled_reason
from linkwright.review.users.left_robot_names import list_lost_names, list_names_of_reason

_ROBOT_KINDS = (SubjectKind.DESCRIPTION, SubjectKind.WORLD)
_REASONS = frozenset(
    reason.template
    for reason in (joint_name_reason(""), make_uncontrolled_reason([""]), make_uncontrolled_reason(["", ""]))
)
"""The templates of the reasons why a parameter file must not lose a joint."""


def relieve_followed_joints(subjects: Sequence[Subject]) -> list[Subject]:
    """Return the subjects; parameter files that lose the joints which robots of the review lose are not breaking.

    The line about the robot already names what breaks. The old parameter file would name joints that no longer exist.
    """
    robots = [subject for subject in subjects if subject.kind in _ROBOT_KINDS]
    joints = {item.name for item in list_lost_names(robots) if not item.is_frame}
    if not joints:
        return list(subjects)
    return [
        replace(subject, changes=[_relieve(change, joints) for change in subject.changes])
        if subject.kind is SubjectKind.PARAMETERS
        else subject
        for subject in subjects
    ]


def _relieve(change: Change, joints: set[str]) -> Change:
    reason = change.reason
    if reason is None or reason.template not in _REASONS or not joints.issuperset(list_names_of_reason(reason)):
        return change
    return replace(change, effect=Effect.CHANGED, reason=None)
