"""Compare the command lines of static transform publishers by the transforms that they publish."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.geometry.single import Quaternion, normalized, quaternion_from_rpy, rpy_from_quaternion
from linkwright.review.launches.titles import TRANSFORM_PUBLISHERS
from linkwright.review.texts.list_changes import split_command

_TRANSLATION = ("x", "y", "z")
_ANGLES = ("yaw", "pitch", "roll")
_QUATERNION = ("qx", "qy", "qz", "qw")
_FRAMES = {"--frame-id": "parent", "--child-frame-id": "child"}
_END_OF_OPTIONS = "--ros-args"
SAME_TRANSFORM = phrase("the same transform in another notation")
"""The change of a publisher whose transform is the same."""
_LENGTH_TOLERANCE = 1e-9
_ANGLE_TOLERANCE = 1e-6
"""The angle in rad up to which two rotations in one notation are equal."""
_NOTATION_TOLERANCE = 1e-3
"""The angle in rad up to which two rotations in different notations are equal."""


@dataclass(frozen=True)
class _Transform:
    """A transform as the command line of a publisher has it.

    Attributes:
        parent: the parent frame.
        child: the child frame.
        translation: the texts of x, y and z.
        rotation: the texts of yaw, pitch and roll, or of a quaternion, by name.
        rest: the other words.
        period: the period of the publisher of tf; empty for that of tf2_ros, which has none.
    """

    parent: str
    child: str
    translation: Mapping[str, str]
    rotation: Mapping[str, str]
    rest: tuple[str, ...] = ()
    period: str = ""


def compare_transforms(old_program: str, new_program: str, old: str | None, new: str | None) -> Phrase | None:
    """Return the change to the transform of a publisher.

    Args:
        old_program: the old package and executable.
        new_program: the new package and executable.
        old: the old arguments of the program; None if it had none.
        new: the new arguments of the program; None if it has none.

    Returns:
        The values that differ, or the sentence that only the notation does; None if the transforms are unknown.
    """
    before, after = _read_transform(old_program, old or ""), _read_transform(new_program, new or "")
    if before is None or after is None:
        return None
    try:
        changes = list(_compare(before, after))
    except ValueError:
        return None
    if not changes:
        return SAME_TRANSFORM
    return joined(changes)


def find_child_frame(program: str, text: str) -> str:
    """Return the child frame in the arguments of a program, as it is written; empty if it is unknown."""
    transform = _read_transform(program, text)
    return "" if transform is None else transform.child


def _read_transform(program: str, text: str) -> _Transform | None:
    if not program.startswith(TRANSFORM_PUBLISHERS):
        return None
    words = split_command(text)
    end = words.index(_END_OF_OPTIONS) if _END_OF_OPTIONS in words else len(words)
    words, rest = words[:end], tuple(words[end:])
    if any(word.startswith("--") for word in words):
        return _read_options(words, rest)
    period = words.pop() if program.startswith("tf/") and words else ""
    names = {8: _ANGLES, 9: _QUATERNION}.get(len(words))
    if names is None:
        return None
    rotation = dict(zip(names, words[3:-2], strict=True))
    return _Transform(words[-2], words[-1], dict(zip(_TRANSLATION, words[:3], strict=True)), rotation, rest, period)


def _read_options(words: Sequence[str], rest: tuple[str, ...]) -> _Transform | None:
    options = dict(zip(words[::2], words[1::2], strict=False))
    names = [name.removeprefix("--") for name in options if name not in _FRAMES]
    has_quaternion = any(name in _QUATERNION for name in names)
    rotation_names = _QUATERNION if has_quaternion else _ANGLES
    if len(words) % 2 or not set(names) <= {*_TRANSLATION, *rotation_names} or not _FRAMES.keys() <= options.keys():
        return None

    def get_values(keys: Sequence[str]) -> dict[str, str]:
        return {name: options.get(f"--{name}", "1" if name == "qw" else "0") for name in keys}

    return _Transform(
        options["--frame-id"],
        options["--child-frame-id"],
        get_values(_TRANSLATION),
        get_values(rotation_names),
        rest,
    )


def _compare(old: _Transform, new: _Transform) -> Iterator[Phrase]:
    """Yield the differences of two transforms.

    Raises:
        ValueError: two notations of a rotation cannot be compared.
    """
    if old.parent != new.parent:
        yield phrase("parent frame '{old}' -> '{new}'", old=old.parent, new=new.parent)
    if old.child != new.child:
        yield phrase("child frame '{old}' -> '{new}'", old=old.child, new=new.child)
    yield from _compare_values(old.translation, new.translation)
    yield from _compare_rotations(old.rotation, new.rotation)
    has_periods = bool(old.period and new.period)
    old_rest, new_rest = (
        " ".join((transform.period, *transform.rest) if has_periods else transform.rest) for transform in (old, new)
    )
    if old_rest != new_rest:
        yield phrase("other arguments {old} -> {new}", old=old_rest or "''", new=new_rest or "''")


def _compare_values(old: Mapping[str, str], new: Mapping[str, str]) -> Iterator[Phrase]:
    for name, value in new.items():
        if not _is_equal(old[name], value):
            yield phrase("{parameter} {old} -> {new}", parameter=name, old=old[name], new=value)


def _is_equal(old: str, new: str) -> bool:
    if old == new:
        return True
    try:
        return math.isclose(float(old), float(new), rel_tol=0, abs_tol=_LENGTH_TOLERANCE)
    except ValueError:
        return False


def _compare_rotations(old: Mapping[str, str], new: Mapping[str, str]) -> Iterator[Phrase]:
    if old.keys() == new.keys() and all(_is_equal(old[name], new[name]) for name in new):
        return
    try:
        before, after = _read_quaternion(old), _read_quaternion(new)
    except ValueError:
        if old.keys() != new.keys():
            raise ValueError from None
        yield from _compare_values(old, new)
        return
    cosine = abs(sum(a * b for a, b in zip(before, after, strict=True)))
    angle = 2 * math.acos(min(1.0, cosine))
    if angle <= (_ANGLE_TOLERANCE if old.keys() == new.keys() else _NOTATION_TOLERANCE):
        return
    changes = list(_compare_values(old, new)) if old.keys() == new.keys() else []
    if not changes:
        old_text, new_text = (_format_rpy(quaternion) for quaternion in (before, after))
        changes = [phrase("{parameter} {old} -> {new}", parameter="rpy", old=old_text, new=new_text)]
    yield phrase("{change} (rotated by {angle:.3g}°)", change=joined(changes), angle=math.degrees(angle))


def _format_rpy(quaternion: Quaternion) -> str:
    return " ".join(f"{value + 0.0:.6g}" for value in rpy_from_quaternion(quaternion))


def _read_quaternion(rotation: Mapping[str, str]) -> Quaternion:
    """Return the normalized quaternion of a rotation.

    Raises:
        ValueError: a value is not a number, or the quaternion is zero.
    """
    numbers = {name: float(value) for name, value in rotation.items()}
    if "qw" not in numbers:
        return quaternion_from_rpy((numbers["roll"], numbers["pitch"], numbers["yaw"]))
    if not any(numbers.values()):
        raise ValueError
    return normalized(numbers["qx"], numbers["qy"], numbers["qz"], numbers["qw"])
