"""Find removed parts that the robot still has with the opposite value of an added boolean argument."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from typing import NamedTuple

from linkwright.descriptions.comparison import Difference
from linkwright.descriptions.pairs import Pair
from linkwright.diagnostics import Phrase, phrase
from linkwright.review.file_pair import FilePair
from linkwright.review.robots.cases import MAX_SWITCHES, Case, find_opposites, list_unused_arguments, try_read

_CONTENTS = "{change}: {contents}"
"""The form of the line about a removed element of an extension."""
_SHAPE = " geometry"
"""The property with the shape of a visual or collision, after its number."""
_Part = tuple[str, str, str]
"""The kind of an object, its name and the property; the latter is empty for the whole object."""


class _Switch(NamedTuple):
    """An added argument with the opposite of its default.

    Attributes:
        text: the argument with its value, as on a command line.
        lacking: the parts that the new robot lacks with this value, or that have another shape there.
        values: the values that differ from the old robot with this value of the argument.
    """

    text: str
    lacking: frozenset[_Part]
    values: Mapping[_Part, str]


class SwitchedParts:
    """The parts that a robot only has with a value of an added argument.

    Args:
        pair: both versions of the description.
        case: the description with one set of argument values.
    """

    def __init__(self, pair: FilePair, case: Case) -> None:
        self._pair = pair
        self._case = case

    def add_switch(self, text: Phrase, difference: Difference) -> Phrase:
        """Return the line about a difference, with the argument that brings a removed part back."""
        if not _is_removal(difference):
            return text
        key = _make_key(difference)
        switch = next((switch for switch in self._switches if key not in switch.lacking), None)
        if switch is None:
            return text
        if key in switch.values:
            value = switch.values[key]
            return phrase("{change}; with {switch}, it is {value}", change=text, switch=switch.text, value=value)
        if text.template == _CONTENTS:
            return phrase("{change}: {contents}; now only with {switch}", **text.arguments, switch=switch.text)
        return phrase("{change}; now only with {switch}", change=text, switch=switch.text)

    @cached_property
    def _switches(self) -> list[_Switch]:
        return list(self._find_switches())

    def _find_switches(self) -> Iterator[_Switch]:
        case = self._case
        robot = case.old.robot
        if robot is None or case.partial is not None or case.old.expansion is None or case.new.expansion is None:
            return
        old_arguments = case.old.expansion.arguments.keys() - list_unused_arguments(case.old)
        added = {name: value for name, value in case.new.expansion.arguments.items() if name not in old_arguments}
        switched = find_opposites(self._pair.versions.new, case.new, added)
        for name, value in list(switched.items())[:MAX_SWITCHES]:
            model = self._pair.versions.new.model(self._pair.new_path, {**case.models.new.values, name: value})
            new = try_read(model)
            new_robot = getattr(new, "robot", None)
            if new_robot is not None:
                comparison = Pair(case.models.old, model).compare(robot, new_robot)
                lacking = frozenset(_list_lacking_parts(comparison.differences))
                changed = (difference for difference in comparison.differences if difference.kind == "changed")
                values = {_make_key(difference): difference.new or "''" for difference in changed}
                yield _Switch(f"{name}:={value}", lacking, values)


def _is_removal(difference: Difference) -> bool:
    return difference.kind == "removed" or (
        difference.kind == "changed" and difference.new is None and difference.old is not None
    )


def _list_lacking_parts(differences: Iterable[Difference]) -> Iterator[_Part]:
    for difference in differences:
        subject, name, part = _make_key(difference)
        if _is_removal(difference):
            yield subject, name, part
        elif _SHAPE in part:
            yield subject, name, part.partition(_SHAPE)[0]


def _make_key(difference: Difference) -> _Part:
    return difference.subject, difference.name, difference.property
