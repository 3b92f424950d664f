"""Decide whether changed position limits of a joint are breaking: limits that are narrower, or gone."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, phrase
from linkwright.urdf import Joint, Robot

LOWER, UPPER = "lower", "upper"
_MIN_CHANGE = 0.01
"""The minimum part of the old range that a narrower limit takes away. Less is rounding, as from 3.1416 to 3.14."""
_CONTINUOUS = "continuous"
_REVOLUTE = "revolute"


def find_narrower_reason(name: str, limits: Mapping[str, tuple[str, str]], unit: str = "") -> Phrase | None:
    """Return why changed position limits are breaking; None if they are not narrower.

    Args:
        name: the name of the joint.
        limits: the old and new values of the changed limits, by `LOWER` and `UPPER`. Expressions are skipped.
        unit: the unit of the limits.
    """
    numbers = {side: pair for side, texts in limits.items() if (pair := _parse_pair(texts)) is not None}
    narrower = {side: new for side, (old, new) in numbers.items() if _is_narrower(side, old, new)}
    values = {side: " ".join(filter(None, (f"{value:.6g}", unit))) for side, value in narrower.items()}
    if len(values) == len((LOWER, UPPER)):
        return phrase(
            "positions of '{name}' below {lower} and above {upper} are now outside of its limits",
            name=name,
            lower=values[LOWER],
            upper=values[UPPER],
        )
    if UPPER in values:
        return phrase(
            "positions of '{name}' above {limit} are now outside of its limits", name=name, limit=values[UPPER]
        )
    if LOWER in values:
        return phrase(
            "positions of '{name}' below {limit} are now outside of its limits", name=name, limit=values[LOWER]
        )
    return None


def find_limits_reason(differences: Iterable[Difference], robot: Robot) -> Phrase | None:
    """Return why the differences in the limits of a joint are breaking; None if they are not narrower.

    Args:
        differences: the differences in the values of one joint.
        robot: the robot of the new version.
    """
    limits: dict[str, tuple[str, str]] = {}
    joint, unit = None, ""
    for difference in differences:
        block, _, side = difference.property.partition(" ")
        if block == "limit" and side in (LOWER, UPPER) and difference.old and difference.new:
            limits[side] = difference.old, difference.new
            joint, unit = robot.joints.get(difference.name), difference.unit
    if joint is None or joint.mimic is not None or joint.type == _CONTINUOUS:
        return None  # such a joint has no position limits of its own
    return find_narrower_reason(joint.name, limits, unit)


def find_limited_reason(old_type: str, new: Joint) -> Phrase | None:
    """Return why another type of a rotating joint is breaking; None if both versions have limits, or neither."""
    if (old_type, new.type) == (_REVOLUTE, _CONTINUOUS):
        return make_lost_limits_reason(new.name)
    if (old_type, new.type) != (_CONTINUOUS, _REVOLUTE) or new.limit is None:
        return None
    return phrase(
        "positions of '{name}' below {lower} and above {upper} are now outside of its limits",
        name=new.name,
        lower=f"{new.limit.lower:.6g} rad",
        upper=f"{new.limit.upper:.6g} rad",
    )


def find_written_reason(name: str, value: str, old: str, new: str) -> Phrase | None:
    """Return why a changed value of a joint in a file that is not expanded is breaking; None if it is not.

    Args:
        name: the name of the joint.
        value: the changed attribute: its type, or a limit.
        old: the old value.
        new: the new value.
    """
    if value == "type" and (old, new) == (_REVOLUTE, _CONTINUOUS):
        return make_lost_limits_reason(name)
    return find_narrower_reason(name, {value: (old, new)}) if value in (LOWER, UPPER) else None


def make_lost_limits_reason(name: str) -> Phrase:
    """Return the reason why a joint without limits is breaking."""
    return phrase("controllers and planners no longer keep '{name}' within position limits", name=name)


def _parse_pair(texts: tuple[str, str]) -> tuple[float, float] | None:
    try:
        return float(texts[0]), float(texts[1])
    except ValueError:
        return None


def _is_narrower(side: str, old: float, new: float) -> bool:
    change = old - new if side == UPPER else new - old
    return change > _MIN_CHANGE * max(abs(old), abs(new))
