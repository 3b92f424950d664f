"""The kind of drive that a robot's wheels suggest.

If they suggest none, a finding names the option to use.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.inference.model import Drive, DriveKind, Wheel
from linkwright.inference.undercarriage import Survey, Undercarriage

_IN_LINE = 0.06
"""The greatest offset of a left wheel to the front or rear of its right one, as a part of their distance."""

_ALIKE = 0.05
"""How far the radii of a pair may differ, as a part of the larger."""

_MUCH_SMALLER = 0.8
"""A pair of wheels with less than this part of another pair's radius may be there for support only."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """The drive that the wheels suggest.

    Attributes:
        drive: the drive; None if it is unknown.
        reason: the reason for the drive, or why it is unknown; a clause.
        extra_casters: the links of wheels that are casters in view of the other wheels.
    """

    drive: Drive | None
    reason: Phrase
    extra_casters: tuple[str, ...] = ()


Pair = tuple[Wheel, Wheel]


def judge(
    survey: Survey, under: Undercarriage, wanted: DriveKind | None = None, chosen: Sequence[Wheel] = ()
) -> Verdict:
    """Return the drive of a robot with wheels.

    Args:
        survey: the robot.
        under: its undercarriage.
        wanted: the kind requested by the user; None to infer it from the wheels.
        chosen: the driven wheels named by the user; empty to find them.
    """
    wheels = tuple(chosen) or under.wheels
    if not chosen and under.crooked and wanted is None:
        names = quoted_names([wheel.joint for wheel in under.crooked])
        return Verdict(None, phrase("the wheels on {names} do not roll forward along x", names=names))
    fixed, single = _pairs([wheel for wheel in wheels if wheel.steering is None or chosen])
    steered, single_steered = _pairs([] if chosen else [wheel for wheel in wheels if wheel.steering is not None])
    if wanted == "ackermann" and chosen:
        steered, single_steered = _pairs([wheel for wheel in under.wheels if wheel.steering is not None])
        fixed = [pair for pair in fixed if pair not in steered]
    if single_steered:
        names = quoted_names([wheel.joint for wheel in single_steered])
        return Verdict(None, phrase("the wheels on {names} are steered, but are not a pair", names=names))
    casters: list[str] = []
    if single:
        casters = [wheel.link for wheel in single if _supports_only(wheel, fixed)]
        others = [wheel.joint for wheel in single if wheel.link not in casters]
        if others and (chosen or wanted is None):
            return Verdict(None, phrase("no wheel is opposite {names}", names=quoted_names(others)))
    verdict = _of_pairs(survey, fixed, steered, wanted)
    return Verdict(verdict.drive, verdict.reason, tuple(casters))


def _of_pairs(survey: Survey, fixed: list[Pair], steered: list[Pair], wanted: DriveKind | None) -> Verdict:
    kind = wanted or _kind_of(survey, fixed, steered)
    if kind is None:
        return Verdict(None, _why_none(fixed, steered))
    lacks = _lacking(kind, fixed, steered)
    if lacks is not None:
        return Verdict(None, lacks)
    if kind == "differential":
        fixed = fixed[:1]
    if kind == "ackermann":
        front = steered[0][0].center[0]
        fixed = sorted(fixed, key=lambda pair: -abs(pair[0].center[0] - front))[:1]
    left, right = tuple(pair[0] for pair in fixed), tuple(pair[1] for pair in fixed)
    separation = sum(abs(a.center[1] - b.center[1]) for a, b in fixed) / len(fixed)
    drive = Drive(kind, left, right, steered[0] if kind == "ackermann" else (), separation)
    return Verdict(drive, _reason(drive))


def _kind_of(survey: Survey, fixed: list[Pair], steered: list[Pair]) -> DriveKind | None:
    """Return the kind of drive that the wheel pairs suggest; None if they suggest several kinds or none."""
    if steered:
        return "ackermann" if len(steered) == 1 and fixed else None
    if not fixed:
        return None
    if len(fixed) == 1:
        return "differential"
    radii = [wheel.radius for pair in fixed for wheel in pair]
    if min(radii) < _MUCH_SMALLER * max(radii):
        return None
    if len(fixed) == 2 and survey.is_mecanum(tuple(wheel for pair in fixed for wheel in pair)):
        return "mecanum"
    return "skid"


def _why_none(fixed: list[Pair], steered: list[Pair]) -> Phrase:
    if len(steered) > 1:
        return phrase("there are {count} pairs of steered wheels", count=len(steered))
    if steered:
        return phrase("there are steered wheels, but no other pair that could drive")
    if fixed:
        return phrase("there are pairs of wheels of different sizes, one of which may only support the robot")
    return phrase("there is no pair of wheels, one on the left and one on the right")


def _lacking(kind: DriveKind, fixed: list[Pair], steered: list[Pair]) -> Phrase | None:
    """Return what a kind of drive lacks, or None if it lacks nothing."""
    if kind == "ackermann" and len(steered) != 1:
        return phrase(
            "it needs one pair of wheels that vertical joints steer, but there are {count}", count=len(steered)
        )
    least = {"mecanum": 2, "skid": 2}.get(kind, 1)
    if len(fixed) < least:
        return phrase(
            "it needs {least} pairs of wheels, each with one on the left and one on the right, but there are {count}",
            least=least,
            count=len(fixed),
        )
    if kind == "differential" and len(fixed) > 1:
        return phrase("it needs one pair of driven wheels, but there are {count}", count=len(fixed))
    return None


def _reason(drive: Drive) -> Phrase:
    names = quoted_names([wheel.joint for pair in zip(drive.left, drive.right, strict=True) for wheel in pair])
    size = phrase(
        "{separation:.4g} m apart, with wheels of {diameter:.4g} m",
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


def _pairs(wheels: Sequence[Wheel]) -> tuple[list[Pair], list[Wheel]]:
    """Return the pairs of opposite left and right wheels, the foremost first, and the remaining wheels."""
    left = sorted((wheel for wheel in wheels if wheel.center[1] > 0.0), key=lambda other: -other.center[0])
    right = [wheel for wheel in wheels if wheel.center[1] <= 0.0]
    pairs: list[Pair] = []
    alone: list[Wheel] = []
    for wheel in left:
        opposite = min(right, key=lambda other: _skew(wheel, other), default=None)
        if opposite is None or not _fit(wheel, opposite):
            alone.append(wheel)
            continue
        right.remove(opposite)
        pairs.append((wheel, opposite))
    return pairs, alone + right


def _skew(left: Wheel, right: Wheel) -> float:
    """Return by how much a wheel differs from the mirror image of another wheel, in m."""
    return abs(left.center[0] - right.center[0]) + abs(left.center[1] + right.center[1])


def _fit(left: Wheel, right: Wheel) -> bool:
    apart = left.center[1] - right.center[1]
    return (
        apart > min(left.radius, right.radius) * 0.5
        and abs(left.center[0] - right.center[0]) <= _IN_LINE * apart
        and abs(left.radius - right.radius) <= _ALIKE * max(left.radius, right.radius)
    )


def _supports_only(wheel: Wheel, pairs: list[Pair]) -> bool:
    """Return whether a wheel without an opposite wheel is a caster.

    A caster is a ball, or much smaller than the paired wheels.
    """
    largest = max((wheel.radius for pair in pairs for wheel in pair), default=0.0)
    return bool(pairs) and (wheel.width is None or wheel.radius < _MUCH_SMALLER * largest)
