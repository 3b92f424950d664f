"""Find removed parts that the robot still has with another value of an argument."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cached_property
from itertools import islice
from typing import NamedTuple

from linkwright.descriptions import Description
from linkwright.descriptions.argument_sets import compared_values
from linkwright.descriptions.comparison import Difference
from linkwright.descriptions.pairs import Pair
from linkwright.diagnostics import Phrase, phrase
from linkwright.review.file_pair import FilePair
from linkwright.review.robots.cases import (
    MAX_SWITCHES,
    OPPOSITES,
    Case,
    find_opposites,
    list_unused_arguments,
    try_read,
)

_MAX_COMPARED = 3
"""The maximum number of values of arguments to try because a condition compares them."""
_CONTENTS = "{change}: {contents}"
"""The form of the line about a removed element of an extension."""
_SHAPE = " geometry"
"""The property with the shape of a visual or collision, after its number."""
_WORD = re.compile(r"[A-Za-z_]\w*")
_Part = tuple[str, str, str]
"""The kind of an object, its name and the property; the latter is empty for the whole object."""


class _Switch(NamedTuple):
    """An argument with another value than in the compared robots.

    Attributes:
        text: the argument with its value, as on a command line.
        lacking: the parts that the new robot lacks with this value, or that have another shape there.
        values: the values that differ from the old robot with this value of the argument.
    """

    text: str
    lacking: frozenset[_Part]
    values: Mapping[_Part, str]


class SwitchedParts:
    """The parts that a robot only has with another value of an argument.

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
        wholes = _list_wholes(key)
        switch = next((switch for switch in self._switches if switch.lacking.isdisjoint(wholes)), None)
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
        version = self._pair.versions.new
        switched = list(find_opposites(version, case.new, added).items())
        switched += find_opposites(version, case.new, self._find_named_arguments(case.new, added)).items()
        switched += islice(dict.fromkeys(self._find_compared_values(case.new, added)), _MAX_COMPARED)
        for name, value in switched[:MAX_SWITCHES]:
            model = version.model(self._pair.new_path, {**case.models.new.values, name: value})
            new = try_read(model)
            new_robot = getattr(new, "robot", None)
            if new_robot is not None:
                comparison = Pair(case.models.old, model).compare(robot, new_robot)
                lacking = frozenset(_list_lacking_parts(comparison.differences))
                changed = (difference for difference in comparison.differences if difference.kind == "changed")
                values = {_make_key(difference): difference.new or "''" for difference in changed}
                yield _Switch(f"{name}:={value}", lacking, values)

    def _find_named_arguments(self, new: Description, added: Collection[str]) -> dict[str, str]:
        """Return the arguments that both versions have and a changed file of the description names, with their values.

        A part can move behind a condition on such an argument.
        """
        version = self._pair.versions.new
        changed = {file.new_path for file in self._pair.versions.changed_files}
        texts = (
            version.text(path) for path in map(version.relative, new.files) if path is not None and path in changed
        )
        words = {word for text in texts for word in _WORD.findall(text)}
        arguments = {} if new.expansion is None else new.expansion.arguments
        return {name: value for name, value in arguments.items() if name not in added and name in words}

    def _find_compared_values(self, new: Description, added: Collection[str]) -> Iterator[tuple[str, str]]:
        """Yield the other values to which conditions compare added arguments, or changed files compare any argument."""
        version = self._pair.versions.new
        changed = {file.new_path for file in self._pair.versions.changed_files}
        arguments = {} if new.expansion is None else new.expansion.arguments
        for compared in compared_values(new.sources.values()):
            is_in_changed = compared.span is not None and version.relative(compared.span.file) in changed
            for name, value in compared.values.items():
                is_other = arguments.get(name, value) != value and value not in OPPOSITES
                if is_other and (name in added or is_in_changed):
                    yield name, value


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


def _list_wholes(part: _Part) -> list[_Part]:
    """Return a part, the parts that contain it, and the whole object."""
    subject, name, text = part
    words = text.split(" ")
    return [(subject, name, " ".join(words[:count])) for count in range(len(words) + 1)]


def _make_key(difference: Difference) -> _Part:
    return difference.subject, difference.name, difference.property
