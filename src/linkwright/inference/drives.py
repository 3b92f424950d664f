"""The inference of the kind of drive from a robot's wheels.

If the kind cannot be inferred, a finding names the option that sets it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.inference.results import Drive, DriveKind, Wheel
from linkwright.inference.undercarriage import Survey, Undercarriage

_MAX_OFFSET = 0.06
"""The maximum offset along x between the wheels of a pair, as a fraction of their distance."""

_MAX_RADIUS_DIFFERENCE = 0.05
"""The maximum difference between the radii of a pair, as a fraction of the larger radius."""

_SUPPORT_RADIUS_FRACTION = 0.8
"""A wheel with less than this fraction of another pair's radius may only support the robot."""


@dataclass(frozen=True, slots=True)
class DriveVerdict:
    """The drive that the wheels suggest, and the reason.

    Attributes:
        drive: the drive; None if it is unknown.
        reason: the reason for this drive, or the reason why it is unknown; a clause.
        extra_casters: the links of wheels that turn out to be casters, because other wheels form pairs.
    """

    drive: Drive | None
    reason: Phrase
    extra_casters: tuple[str, ...] = ()


Pair = tuple[Wheel, Wheel]


def infer_drive(
    survey: Survey,
    undercarriage: Undercarriage,
    requested_kind: DriveKind | None = None,
    chosen_wheels: Sequence[Wheel] = (),
) -> DriveVerdict:
    """Return the drive of a robot with wheels.

    Args:
        survey: the facts about the robot.
        undercarriage: the wheels and casters of the robot.
        requested_kind: the kind that the user has chosen; None to infer it from the wheels.
        chosen_wheels: the driven wheels that the user has chosen; empty to find them.
    """
    wheels = tuple(chosen_wheels) or undercarriage.wheels
    if not chosen_wheels and undercarriage.misaligned and requested_kind is None:
        names = quoted_names([wheel.joint for wheel in undercarriage.misaligned])
        return DriveVerdict(None, phrase("the wheels on {names} do not roll forward along x", names=names))
    fixed_pairs, unpaired = _pair_wheels([wheel for wheel in wheels if wheel.steering is None or chosen_wheels])
    steered_pairs, unpaired_steered = _pair_wheels(
        [] if chosen_wheels else [wheel for wheel in wheels if wheel.steering is not None]
    )
    if requested_kind == "ackermann" and chosen_wheels:
        steered_pairs, unpaired_steered = _pair_wheels(
            [wheel for wheel in undercarriage.wheels if wheel.steering is not None]
        )
        fixed_pairs = [pair for pair in fixed_pairs if pair not in steered_pairs]
    if unpaired_steered:
        names = quoted_names([wheel.joint for wheel in unpaired_steered])
        return DriveVerdict(None, phrase("the wheels on {names} are steered, but are not a pair", names=names))
    casters: list[str] = []
    if unpaired:
        casters = [wheel.link for wheel in unpaired if _supports_only(wheel, fixed_pairs)]
        unpaired_joints = [wheel.joint for wheel in unpaired if wheel.link not in casters]
        if unpaired_joints and (chosen_wheels or requested_kind is None):
            return DriveVerdict(None, phrase("no wheel is opposite {names}", names=quoted_names(unpaired_joints)))
    verdict = _create_drive_from_pairs(survey, fixed_pairs, steered_pairs, requested_kind)
    return DriveVerdict(verdict.drive, verdict.reason, tuple(casters))


def _create_drive_from_pairs(
    survey: Survey, fixed_pairs: list[Pair], steered_pairs: list[Pair], requested_kind: DriveKind | None
) -> DriveVerdict:
    kind = requested_kind or _suggest_kind(survey, fixed_pairs, steered_pairs)
    if kind is None:
        return DriveVerdict(None, _explain_unknown_kind(fixed_pairs, steered_pairs))
    problem = _find_missing_wheels(kind, fixed_pairs, steered_pairs)
    if problem is not None:
        return DriveVerdict(None, problem)
    if kind == "differential":
        fixed_pairs = fixed_pairs[:1]
    if kind == "ackermann":
        front_x = steered_pairs[0][0].center[0]
        fixed_pairs = sorted(fixed_pairs, key=lambda pair: -abs(pair[0].center[0] - front_x))[:1]
    left, right = tuple(pair[0] for pair in fixed_pairs), tuple(pair[1] for pair in fixed_pairs)
    separation = sum(
        abs(left_wheel.center[1] - right_wheel.center[1]) for left_wheel, right_wheel in fixed_pairs
    ) / len(fixed_pairs)
    drive = Drive(kind, left, right, steered_pairs[0] if kind == "ackermann" else (), separation)
    return DriveVerdict(drive, _explain_drive(drive))


def _suggest_kind(survey: Survey, fixed_pairs: list[Pair], steered_pairs: list[Pair]) -> DriveKind | None:
    """Return the kind of drive that the wheel pairs suggest, or None if it is unknown."""
    if steered_pairs:
        return "ackermann" if len(steered_pairs) == 1 and fixed_pairs else None
    if not fixed_pairs:
        return None
    if len(fixed_pairs) == 1:
        return "differential"
    radii = [wheel.radius for pair in fixed_pairs for wheel in pair]
    if min(radii) < _SUPPORT_RADIUS_FRACTION * max(radii):
        return None
    if len(fixed_pairs) == 2 and survey.is_mecanum(tuple(wheel for pair in fixed_pairs for wheel in pair)):
        return "mecanum"
    return "skid"


def _explain_unknown_kind(fixed_pairs: list[Pair], steered_pairs: list[Pair]) -> Phrase:
    if len(steered_pairs) > 1:
        return phrase("there are {count} pairs of steered wheels", count=len(steered_pairs))
    if steered_pairs:
        return phrase("there are steered wheels, but no other pair of wheels that could be driven")
    if fixed_pairs:
        return phrase("its pairs of wheels differ in size, so one of them may only support the robot")
    return phrase("there is no pair of wheels, one on the left and one on the right")


def _find_missing_wheels(kind: DriveKind, fixed_pairs: list[Pair], steered_pairs: list[Pair]) -> Phrase | None:
    """Return the requirement of a kind of drive that the wheels do not meet, or None."""
    if kind == "ackermann" and len(steered_pairs) != 1:
        return phrase(
            "it needs one pair of wheels that are steered by vertical joints, but there are {count}",
            count=len(steered_pairs),
        )
    min_pairs = {"mecanum": 2, "skid": 2}.get(kind, 1)
    if len(fixed_pairs) < min_pairs:
        return phrase(
            "it needs {minimum} pairs of wheels, each with one on the left and one on the right, but there are {count}",
            minimum=min_pairs,
            count=len(fixed_pairs),
        )
    if kind == "differential" and len(fixed_pairs) > 1:
        return phrase("it needs one pair of driven wheels, but there are {count}", count=len(fixed_pairs))
    return None


def _explain_drive(drive: Drive) -> Phrase:
    names = quoted_names([wheel.joint for pair in zip(drive.left, drive.right, strict=True) for wheel in pair])
    size = phrase(
        "{separation:.4g} m apart and {diameter:.4g} m in diameter",
        separation=drive.separation,
        diameter=2.0 * drive.radius,
    )
    if drive.kind == "ackermann":
        joints = quoted_names([wheel.steering or "" for wheel in drive.steered])
        return phrase(
            "{names} turn wheels on the ground, {size}, and {joints} steer", names=names, size=size, joints=joints
        )
    if drive.kind == "mecanum":
        return phrase("{names} turn wheels that are named mecanum, {size}", names=names, size=size)
    return phrase("{names} turn wheels on the ground, {size}", names=names, size=size)


def _pair_wheels(wheels: Sequence[Wheel]) -> tuple[list[Pair], list[Wheel]]:
    """Return the pairs of opposite wheels, the foremost pair first, and the other wheels."""
    left_wheels = sorted((wheel for wheel in wheels if wheel.center[1] > 0.0), key=lambda other: -other.center[0])
    right_wheels = [wheel for wheel in wheels if wheel.center[1] <= 0.0]
    pairs: list[Pair] = []
    unpaired: list[Wheel] = []
    for wheel in left_wheels:
        opposite = min(right_wheels, key=lambda other: _compute_mirror_distance(wheel, other), default=None)
        if opposite is None or not _are_pair(wheel, opposite):
            unpaired.append(wheel)
            continue
        right_wheels.remove(opposite)
        pairs.append((wheel, opposite))
    return pairs, unpaired + right_wheels


def _compute_mirror_distance(left: Wheel, right: Wheel) -> float:
    """Return how far a wheel is from the mirror image of another wheel, in m."""
    return abs(left.center[0] - right.center[0]) + abs(left.center[1] + right.center[1])


def _are_pair(left: Wheel, right: Wheel) -> bool:
    distance = left.center[1] - right.center[1]
    return (
        distance > min(left.radius, right.radius) * 0.5
        and abs(left.center[0] - right.center[0]) <= _MAX_OFFSET * distance
        and abs(left.radius - right.radius) <= _MAX_RADIUS_DIFFERENCE * max(left.radius, right.radius)
    )


def _supports_only(wheel: Wheel, pairs: list[Pair]) -> bool:
    """Return whether a wheel without an opposite wheel only supports the robot.

    Such a caster is a ball, or is much smaller than the paired wheels.
    """
    max_radius = max((wheel.radius for pair in pairs for wheel in pair), default=0.0)
    return bool(pairs) and (wheel.width is None or wheel.radius < _SUPPORT_RADIUS_FRACTION * max_radius)
