"""Drop changed SDF values that are equal but written differently, and join inertials."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.review.files.worlds.sdf_defaults import find_default
from linkwright.review.plugins import is_added, is_removed

_INERTIAL = re.compile(r"(?P<inertial>(?:.* )?inertial) (?P<value>mass|pose|inertia i[xyz]{2})")
"""The path of a value of an inertial."""
_PLUGIN = re.compile(r"(^| )plugin ")
_EQUAL_BOOLEANS = ({"1", "true"}, {"0", "false"})
_FRAME = re.compile(r"@(frame|relative_to)$")
"""The attribute of a pose that names its frame."""
_MOMENTS = frozenset({"ixx", "iyy", "izz"})
_MAX_RELATIVE_DIFFERENCE = 1e-6
"""The maximum difference of two equal values, relative to the largest number of a value."""
_MAX_ABSOLUTE_DIFFERENCE = 1e-15
"""The maximum absolute difference of equal numbers."""
_MAX_RATIO_DIFFERENCE = 1e-2
"""The maximum relative difference of the ratios of the moments of inertia of a scaled tensor."""
_MIN_DIGITS, _MAX_DIGITS = 4, 17
_POSE_LENGTH = 6
"""The number of values in a pose."""
_POSE_PARTS = slice(0, 3), slice(3, _POSE_LENGTH)
"""The position and the rotation in a pose."""
_MAX_SHOWN_ENTRIES = 2
"""The maximum number of changed tensor entries that are shown with both values."""


@dataclass(frozen=True, slots=True)
class InertialDifference(Difference):
    """The differences between several values of the inertial of a link.

    The location is that of the first difference.

    Attributes:
        values: the differences by the name of the value, such as ``mass``, ``pose`` or ``ixx``.
    """

    values: tuple[tuple[str, Difference], ...] = ()

    def format_values(self) -> Phrase:
        """Return the differences in one line."""
        changed = {name: (difference.old or "", difference.new or "") for name, difference in self.values}
        tensor = {name: changed.pop(name) for name in tuple(changed) if name.startswith("i")}
        texts: list[Phrase | str] = []
        if "mass" in changed:
            texts.append("mass {} -> {} kg".format(*_shorten_numbers(*changed["mass"])))
        texts += _format_pose(*changed["pose"]) if "pose" in changed else []
        texts += _format_tensor(tensor) if tensor else []
        return joined(texts)


def drop_rounding(differences: Iterable[Difference]) -> Iterator[Difference]:
    """Yield the differences except numbers that differ only by rounding."""
    return (difference for difference in differences if not _is_rounding(difference))


def is_default(difference: Difference) -> bool:
    """Return whether an added or removed element has the value that SDF gives to an element that is left out."""
    value = _get_lone_value(difference)
    default = None if value is None else find_default(f"{difference.name} {difference.property}".strip())
    if default is None or value is None:
        return False
    return (
        value == default or {value, default} in _EQUAL_BOOLEANS or parse_numbers(value) == parse_numbers(default) != []
    )


def _get_lone_value(difference: Difference) -> str | None:
    """Return the text of an added or removed element without children, or None for other differences."""
    element = difference.element
    if element is None or (is_added(difference) == is_removed(difference)) or any(element.elements()):
        return None
    return element.text().strip()


def drop_equal_values(differences: Iterable[Difference]) -> Iterator[Difference]:
    """Yield the differences between values with different meanings.

    ``1`` and ``true`` are equal, and so are an empty and a missing frame, and a default and a missing element.
    """
    return (
        difference
        for difference in differences
        if not (_is_equal_boolean(difference) or _is_empty_frame(difference) or is_default(difference))
    )


def join_inertials(differences: Iterable[Difference]) -> Iterator[Difference]:
    """Yield the differences, with the differences of the inertial of a link joined into one."""
    for inertial, group in groupby(differences, _find_inertial):
        if not inertial:
            yield from group
            continue
        values = tuple(_drop_tiny_products({_get_value_name(value): value for value in group}).items())
        if values:
            first = values[0][1]
            yield InertialDifference(
                first.subject,
                first.name,
                first.kind,
                inertial.removeprefix(first.name).strip(),
                old_place=first.old_place,
                new_place=first.new_place,
                values=values,
            )


def _find_inertial(difference: Difference) -> str:
    """Return the path of the inertial of a changed value; empty for other differences."""
    match = _INERTIAL.fullmatch(f"{difference.name} {difference.property}".strip())
    count = len(parse_numbers(difference.old))
    is_readable = count in (1, _POSE_LENGTH) and count == len(parse_numbers(difference.new))
    return match["inertial"] if match is not None and is_readable and difference.kind == "changed" else ""


def _get_value_name(difference: Difference) -> str:
    return difference.property.rpartition(" ")[2]


def parse_numbers(text: str | None) -> list[float]:
    """Return the numbers in a text; an empty list if it contains other words."""
    try:
        numbers = [float(word) for word in (text or "").split()]
    except ValueError:
        return []
    return numbers if all(map(math.isfinite, numbers)) else []


def _is_rounding(difference: Difference) -> bool:
    """Return whether the numbers of a difference are equal except for rounding."""
    old, new = parse_numbers(difference.old), parse_numbers(difference.new)
    if difference.kind != "changed" or not old or len(old) != len(new):
        return False
    if not {".", "e", "E"} & set(f"{difference.old}{difference.new}"):
        return False  # integers, such as a seed
    limit = max(_MAX_ABSOLUTE_DIFFERENCE, _MAX_RELATIVE_DIFFERENCE * max(map(abs, (*old, *new))))
    return all(abs(first - second) <= limit for first, second in zip(old, new, strict=True))


def _is_equal_boolean(difference: Difference) -> bool:
    """Return whether the values are equal booleans.

    A plugin parameter is not a boolean, because it can be a text.
    """
    values = {difference.old, difference.new}
    is_of_plugin = _PLUGIN.search(f"{difference.name} {difference.property}") is not None
    return difference.kind == "changed" and values in _EQUAL_BOOLEANS and not is_of_plugin


def _is_empty_frame(difference: Difference) -> bool:
    values = {difference.old or "", difference.new or ""}
    return difference.element is None and _FRAME.search(difference.property) is not None and values == {""}


def _drop_tiny_products(values: dict[str, Difference]) -> dict[str, Difference]:
    """Return the values without products of inertia that hardly change.

    Changes are compared with the moments of inertia.
    """
    moments = [abs(number) for name in _MOMENTS & values.keys() for number in parse_numbers(values[name].old)]
    limit = _MAX_RELATIVE_DIFFERENCE * max(moments, default=0.0)
    return {
        name: value
        for name, value in values.items()
        if not (name.startswith("i") and name not in _MOMENTS and _compute_change_size(value) <= limit)
    }


def _compute_change_size(difference: Difference) -> float:
    (old,), (new,) = parse_numbers(difference.old), parse_numbers(difference.new)
    return abs(new - old)


# --- texts -----------------------------------------------------------------------------------------------------------


def _shorten_numbers(old: str, new: str) -> tuple[str, str]:
    """Return two numbers with as many digits as they need to look different."""
    for digits in range(_MIN_DIGITS, _MAX_DIGITS):
        texts = [f"{float(text):.{digits}g}" for text in (old, new)]
        if texts[0] != texts[1]:
            break
    return texts[0], texts[1]


def _format_pose(old: str, new: str) -> Iterator[Phrase | str]:
    first, second = old.split(), new.split()
    centers, rotations = ([parse_numbers(" ".join(words[part])) for words in (first, second)] for part in _POSE_PARTS)
    if centers[0] != centers[1]:
        text = "center {} -> {} m".format(*(" ".join(f"{number:.6g}" for number in numbers) for numbers in centers))
        yield phrase("{change} (moved by {distance:.4g} m)", change=text, distance=math.dist(*centers))
    if rotations[0] != rotations[1]:
        yield phrase("axes {old} -> {new}", old=" ".join(first[_POSE_PARTS[1]]), new=" ".join(second[_POSE_PARTS[1]]))


def _format_tensor(entries: Mapping[str, tuple[str, str]]) -> Iterator[Phrase | str]:
    numbers = {name: (float(old), float(new)) for name, (old, new) in entries.items()}
    moments = {name: pair for name, pair in numbers.items() if name in _MOMENTS}
    if len(entries) <= _MAX_SHOWN_ENTRIES or not moments or not all(old for old, _ in moments.values()):
        for name, (old, new) in entries.items():
            yield "{} {} -> {} kg m2".format(name, *_shorten_numbers(old, new))
        return
    largest = max(abs(old) for old, _ in moments.values())
    ratio = max(new / old for old, new in moments.values())
    if len(moments) == len(_MOMENTS) and all(
        abs(new - ratio * old) <= _MAX_RATIO_DIFFERENCE * largest for old, new in numbers.values()
    ):
        yield phrase("inertia {ratio:.4g} times as large", ratio=ratio)
        return
    changes = [abs(new - old) / (abs(old) if name in _MOMENTS else largest) for name, (old, new) in numbers.items()]
    yield phrase("inertia changed by up to {percent:.3g} %", percent=100.0 * max(changes))
