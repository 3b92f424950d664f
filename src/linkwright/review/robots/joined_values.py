"""Join the changes in the inertial of a link, the limits of a joint or the numbers of a plugin in one line."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby

from linkwright.descriptions.comparison import GAZEBO, ROS2_CONTROL, Difference
from linkwright.diagnostics import Phrase, joined, phrase, term

_BLOCK_TAGS = ("inertial", "limit")
"""The elements whose values are joined: ``<inertial>`` and ``<limit>``."""
_PART_OF_GAZEBO = re.compile(r"(?P<part>(?:(?:plugin|sensor) \S+ )?)(?P<name>[^@()]+)")
"""The plugin or sensor of a value in ``<gazebo>``, and the rest of its path.

Plugins with the joint in parentheses are merged with those of other joints instead.
"""
_PARAMETER_OF_HARDWARE = re.compile(r"(?P<part>.+) param \S+")
"""The part of the hardware of ros2_control that has a parameter, such as an interface of a joint."""
_NUMBERS = re.compile(r"[-+.\deE ]*\d[-+.\deE ]*|true|false", re.IGNORECASE)
"""The values that are joined. Names, such as topics, can be breaking."""


@dataclass(frozen=True, slots=True)
class JoinedDifferences(Difference):
    """The differences in several values of a block.

    The location is that of the first difference.

    Attributes:
        values: the differences of values that both versions have.
    """

    values: tuple[Difference, ...] = ()

    def sentence(self) -> Phrase:
        """Return the differences in one line."""
        if self.subject == "extension" and not self.name.startswith(ROS2_CONTROL):
            changes = joined([_format_value_of_gazebo(value) for value in self.values])
            changes = (
                phrase("{property}: {changes}", property=self.property, changes=changes) if self.property else changes
            )
            return phrase("{subject} '{name}': {new}", subject=term(self.subject), name=self.name, new=changes)
        return phrase(
            "{subject} '{name}': {property}: {new}",
            subject=term(self.subject),
            name=self.name,
            property=self.property,
            new=", ".join(map(_format_value, self.values)),
        )


def join_value_differences(differences: Iterable[Difference]) -> Iterator[Difference]:
    """Yield the differences, with those in an inertial, a joint's limits, or a plugin, joined."""
    for key, group in groupby(differences, _find_block):
        values = tuple(group)
        if key is None or len(values) == 1:
            yield from values
            continue
        first = values[0]
        yield JoinedDifferences(
            first.subject,
            first.name,
            first.kind,
            property=key[1],
            old_place=first.old_place,
            new_place=first.new_place,
            values=values,
        )


def _find_block(difference: Difference) -> tuple[str, str] | None:
    """Return the link or joint and the block of a changed value, or None.

    The result is None if the value cannot be joined with others.
    """
    if difference.subject == "extension":
        return _find_part_of_extension(difference)
    block = difference.property.partition(" ")[0]
    is_value = difference.kind == "changed" and block in _BLOCK_TAGS and block != difference.property
    return (difference.name, block) if is_value and difference.old and difference.new else None


def _find_part_of_extension(difference: Difference) -> tuple[str, str] | None:
    """Return the extension and the part of it whose number differs, such as a plugin, or None for other values."""
    tag = difference.name.partition(" ")[0]
    pattern = {GAZEBO: _PART_OF_GAZEBO, ROS2_CONTROL: _PARAMETER_OF_HARDWARE}.get(tag)
    match = None if pattern is None else pattern.fullmatch(difference.property)
    values = [value for value in (difference.old, difference.new) if value is not None]
    if match is None or difference.kind != "changed" or not all(map(_NUMBERS.fullmatch, values)):
        return None
    if tag == ROS2_CONTROL and len(values) < 2:
        return None  # several added or removed parameters are one line already
    return difference.name, match["part"].strip()


def _format_value_of_gazebo(difference: Difference) -> Phrase:
    match = _PART_OF_GAZEBO.fullmatch(difference.property)
    name = difference.property if match is None else match["name"]
    if difference.old is None:
        return phrase("{part} added", part=f"{name} {difference.new}")
    if difference.new is None:
        return phrase("{part} removed", part=f"{name} {difference.old}")
    return phrase("{parameter} {old} -> {new}", parameter=name, old=difference.old, new=difference.new)


def _format_value(difference: Difference) -> str:
    """Return the change in a value with its unit, such as ``mass 2 -> 3 kg``."""
    _, space, parameter = difference.property.rpartition(" param ")
    name = f"param {parameter}" if space else difference.property.rpartition(" ")[2]
    words = "center" if name == "xyz" else name, difference.old, "->", difference.new, difference.unit
    return " ".join(filter(None, words))
