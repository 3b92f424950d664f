"""Plan edits: find the smallest edit of the text that makes a requested change.

The texts that may determine a number are tried in turn. The plan uses the first text whose edit changes the expanded
document exactly as requested. If there is none, the edit is refused with a reason.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from itertools import islice
from math import isfinite

from linkwright.descriptions.editing.definitions import attribute
from linkwright.descriptions.editing.difference import Target, describe_path, find_path, other_differences
from linkwright.descriptions.editing.errors import EditRefusedError
from linkwright.descriptions.editing.numbers import EXACT, are_close, parse_numbers, shortest_text
from linkwright.descriptions.editing.proposals import proposals
from linkwright.descriptions.editing.refusals import Attempt, refusal
from linkwright.descriptions.editing.request import EditRequest
from linkwright.descriptions.editing.snapshot import Snapshot
from linkwright.descriptions.editing.text_ranges import Candidate, TextRange, literal, words
from linkwright.descriptions.service import Description
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.geometry.single import quaternion_from_rpy
from linkwright.loading.lean_dataclasses import NamedTuple, dataclass
from linkwright.xacro.faults import Frame
from linkwright.xmltree import Document, Element, Overlay, parse
from linkwright.xmltree.patches import find_start_tag, make_insertion

Allowed = Callable[[str], "Diagnostic | None"]
"""A function that returns the reason why a file must not be written, given its real path, or None."""

_MAX_TRIALS = 60
_MIN_SLOPE = 1e-6
_PLAIN_SLOPES = (1.0, 2.0, 0.5, 0.25)
"""With any other slope, the values 1 and -1 are factors that select a side, not lengths."""
_MAX_VALUE = 1e6
"""The largest number that an edit may request, in m or rad."""
_DEFAULT_VALUES = {"origin": [0.0, 0.0, 0.0], "axis": [1.0, 0.0, 0.0]}
"""The defaults of attributes that are not written."""


@dataclass(frozen=True, slots=True)
class EditPlan:
    """A planned edit.

    Attributes:
        texts: the new text of each changed file without a byte order mark, by real path; empty if nothing changes.
        old_texts: the old texts of the same files, by real path.
        side_effects: the names of other parts that the edit changes, if the request allows this.
    """

    texts: dict[str, str]
    old_texts: dict[str, str]
    side_effects: tuple[str, ...] = ()


def plan_edit(description: Description, request: EditRequest, allowed: Allowed = lambda _: None) -> EditPlan:
    """Return the smallest edit of the text that makes a requested change, and no other change.

    Args:
        description: the description, as it was just read from a file.
        request: the requested change.
        allowed: a function that returns the reason why a file must not be written, or None.

    Raises:
        EditRefusedError: if there is no such edit, with one of the diagnostics EDIT101 to EDIT106.
    """
    planner = _Planner(description, request, allowed)
    for name, requested in planner.requested_values():
        planner.set(name, requested)
    return planner.plan()


class _EditedDescription(NamedTuple):
    """An edited description with the requested number, and the names of other changed parts."""

    snapshot: Snapshot
    side_effects: tuple[str, ...]


class _Planner:
    """The planner of one edit, attribute by attribute and number by number.

    `_current` is the description with the edits so far.
    """

    def __init__(self, description: Description, request: EditRequest, allowed: Allowed) -> None:
        self._request, self._allowed = request, allowed
        self._current = self._first = Snapshot.of(description)
        robot = description.robot
        owner = None if robot is None else request.owner(robot)
        path = None if owner is None else find_path(self._current.root, owner)
        if owner is None or path is None or description.name.startswith("<"):
            message = phrase("'{name}' has no {part} to edit", part=request.part, name=request.name)
            raise EditRefusedError(
                Diagnostic(
                    "EDIT101", message, hint=phrase("select the part again, because the description may have changed")
                )
            )
        self._path, self._owner = path, owner
        self._also_changed: dict[str, None] = {}

    def requested_values(self) -> Iterator[tuple[str, list[float]]]:
        """Yield the name of each attribute to edit, with its requested numbers."""
        request = self._request
        for numbers in (request.xyz, request.rpy):
            if numbers is not None and not all(isfinite(value) and abs(value) <= _MAX_VALUE for value in numbers):
                raise EditRefusedError(
                    Diagnostic("EDIT102", phrase("each number must be finite, and at most 1e6 in magnitude"))
                )
        if request.xyz is not None:
            if request.tag == "axis" and not any(abs(value) > EXACT for value in request.xyz):
                message = phrase("an axis cannot be 0 0 0, which has no direction")
                raise EditRefusedError(Diagnostic("EDIT102", message))
            yield "xyz", list(request.xyz)
        element = self._owner.first(request.tag)
        if request.rpy is not None and element is not None and "quat_xyzw" in element.attributes:
            roll, pitch, yaw = request.rpy
            yield "quat_xyzw", list(quaternion_from_rpy((roll, pitch, yaw)))
        elif request.rpy is not None:
            yield "rpy", list(request.rpy)

    def set(self, name: str, requested: list[float]) -> None:
        """Plan the edits that set an attribute to the requested numbers."""
        current_numbers = self._values(name)
        changed_indexes = [
            i for i, (old, new) in enumerate(zip(current_numbers, requested, strict=True)) if not are_close(old, new)
        ]
        if not changed_indexes:
            return
        target = Target(self._path, self._request.tag, name)
        element = target.element(self._current.root)
        if element is None or name not in element.attributes:
            self._add(target, requested)
            return
        text_range = self._attribute_range(element, name)
        value_words = words(text_range)
        if (
            len(value_words) == len(requested)
            and all(literal(value_words[i]) for i in changed_indexes)
            and len(changed_indexes) > 1
        ):
            combined = self._edit_together(target, text_range, value_words, {i: requested[i] for i in changed_indexes})
            if combined is not None:
                self._current = combined
                return
        for i in changed_indexes:
            self._set_one(target, i, requested[i])

    def plan(self) -> EditPlan:
        """Return the plan of all edits."""
        unsaved = self._first.texts
        texts = {str(path): text for path, text in self._current.texts.items() if unsaved.get(path) != text}
        old_texts = {path: Overlay(unsaved).read(path).text for path in texts}
        return EditPlan(texts, old_texts, tuple(self._also_changed))

    # one number

    def _set_one(self, target: Target, index: int, requested: float) -> None:
        element = target.element(self._current.root)
        assert element is not None, "it has the attribute"
        text_range = self._attribute_range(element, target.attribute)
        current_numbers = self._values(target.attribute)
        frame = element.origin if isinstance(element.origin, Frame) else None
        attempts: list[Attempt] = []
        candidates = proposals(
            text_range,
            index,
            frame,
            self._current.definitions,
            present=current_numbers,
            is_angle=target.attribute == "rpy",
        )
        best_edit: _EditedDescription | None = None
        best_rank = (0, False)
        for candidate in islice(candidates, _MAX_TRIALS):
            edited = self._try_candidate(candidate, target, index, requested, attempts)
            if edited is None:
                continue
            if not edited.side_effects:
                best_edit = edited
                break
            rank = len(edited.side_effects), candidate.is_choice
            if best_edit is None or rank < best_rank:
                best_edit, best_rank = edited, rank
        if best_edit is not None:
            self._current = best_edit.snapshot
            self._also_changed.update(dict.fromkeys(best_edit.side_effects))
            return
        raise EditRefusedError(refusal(text_range, index, attempts))

    def _try_candidate(
        self, candidate: Candidate, target: Target, index: int, requested: float, attempts: list[Attempt]
    ) -> _EditedDescription | None:
        """Try a candidate, and return the edited description, or None if the candidate fails.

        The reason is appended to `attempts`, unless the text does not affect the requested number.
        """
        refusal_reason = self._allowed(os.path.realpath(candidate.text_range.source.name))
        if refusal_reason is not None:
            attempts.append(Attempt(candidate.text_range, forbidden=refusal_reason))
            return None
        current = self._values(target.attribute)[index]
        guess, tolerance = candidate.value + requested - current, EXACT
        for _ in range(2):
            guess = float(shortest_text(guess, tolerance))
            trial = self._try_text(candidate.text_range, candidate.write(guess, tolerance))
            values = None if trial is None else self._numbers_in(trial, target)
            if trial is None or values is None:
                attempts.append(Attempt(candidate.text_range, fails_to_expand=True))
                return None
            change = values[index] - current
            slope = change / (guess - candidate.value) if guess != candidate.value else 0.0
            if abs(slope) < _MIN_SLOPE:
                return None  # the text does not affect the requested number
            if candidate.is_choice and not any(are_close(abs(slope), plain_slope) for plain_slope in _PLAIN_SLOPES):
                attempts.append(Attempt(candidate.text_range, is_choice=True))
                return None
            side_effects = self._find_side_effects(trial, target, index, values)
            if side_effects and not self._request.together:
                attempts.append(
                    Attempt(candidate.text_range, side_effects=side_effects, may_be_choice=candidate.is_choice)
                )
                return None
            if are_close(values[index], requested):
                return _EditedDescription(trial, side_effects)
            guess, tolerance = candidate.value + (requested - current) / slope, EXACT / abs(slope) / 2
        attempts.append(Attempt(candidate.text_range))
        return None

    def _edit_together(
        self, target: Target, text_range: TextRange, value_words: list[TextRange], new_numbers: dict[int, float]
    ) -> Snapshot | None:
        """Return the description after one edit of several literal numbers in an attribute.

        The result is None if the file must not be edited, if the attribute would not get the requested values, or if
        other parts would also change.
        """
        if self._allowed(os.path.realpath(text_range.source.name)) is not None:
            return None
        text, offset = "", text_range.start
        for i, value_word in enumerate(value_words):
            text += text_range.source.text[offset : value_word.start] + (
                shortest_text(new_numbers[i]) if i in new_numbers else value_word.text
            )
            offset = value_word.end
        text += text_range.source.text[offset : text_range.end]
        trial = self._try_text(text_range, text)
        values = None if trial is None else self._numbers_in(trial, target)
        if trial is None or values is None:
            return None
        requested = [new_numbers.get(i, value) for i, value in enumerate(self._values(target.attribute))]
        is_exact = all(map(are_close, values, requested)) and not self._list_differences(trial, target)
        return trial if is_exact else None

    def _try_text(self, text_range: TextRange, text: str) -> Snapshot | None:
        try:
            return self._current.with_text(text_range, text)
        except LinkwrightError:
            return None

    def _find_side_effects(self, trial: Snapshot, target: Target, index: int, values: list[float]) -> tuple[str, ...]:
        """Return the names of the other parts that a trial edit changes."""
        changed_parts = self._list_differences(trial, target)
        current_numbers = self._values(target.attribute)
        if any(values[i] != current_numbers[i] for i in range(len(values)) if i != index):
            changed_parts.append(phrase("another number of the same attribute"))
        return tuple(dict.fromkeys(changed_parts))

    def _list_differences(self, trial: Snapshot, target: Target) -> list[str]:
        return [describe_path(trail) for trail in other_differences(self._current.root, trial.root, target)]

    # missing attributes

    def _add(self, target: Target, requested: list[float]) -> None:
        """Plan the addition of a missing attribute or element."""
        element = target.element(self._current.root)
        text_range, text = self._make_insertion(target, element, " ".join(map(shortest_text, requested)))
        refusal_reason = self._allowed(os.path.realpath(text_range.source.name))
        if refusal_reason is not None:
            raise EditRefusedError(refusal_reason)
        trial = self._try_text(text_range, text)
        values = None if trial is None else self._numbers_in(trial, target)
        side_effects = () if trial is None else tuple(dict.fromkeys(self._list_differences(trial, target)))
        if side_effects and self._request.together:
            self._also_changed.update(dict.fromkeys(side_effects))
            side_effects = ()
        if trial is None or values is None or not all(map(are_close, values, requested)) or side_effects:
            raise EditRefusedError(
                refusal(
                    text_range,
                    None,
                    [Attempt(text_range, side_effects=side_effects, fails_to_expand=not side_effects)],
                    tag=target.tag,
                )
            )
        self._current = trial

    def _make_insertion(self, target: Target, element: Element | None, text: str) -> tuple[TextRange, str]:
        if element is not None:
            source_element = self._source_element(element)
            tag = find_start_tag(source_element)
            if tag is not None and source_element.source is not None:
                return TextRange(
                    source_element.source, tag.insertion_offset, tag.insertion_offset
                ), f' {target.attribute}="{text}"'
            raise EditRefusedError(_make_not_written_finding(element))
        owner = target.owner(self._current.root)
        assert owner is not None, "it was found before"
        source_element = self._source_element(owner)
        new_element = Element(target.tag, {target.attribute: text})
        previous = None
        if target.tag == "axis":
            previous = next(
                (element for tag in ("child", "parent", "origin") for element in source_element.elements(tag)), None
            )
        edit = make_insertion(source_element, [new_element], after=previous, first=previous is None)
        if edit is None or source_element.source is None:
            raise EditRefusedError(_make_not_written_finding(owner))
        return TextRange(source_element.source, edit.start, edit.end), edit.text

    def _source_element(self, element: Element) -> Element:
        """Return the unexpanded element in the file for an element of the expansion."""
        if element.source is None:
            raise EditRefusedError(_make_not_written_finding(element))
        document: Document = parse(element.source.text, element.source.name)
        source_element = next((child for child in document.root.walk() if child.offset == element.offset), None)
        if source_element is None:
            raise EditRefusedError(_make_not_written_finding(element))
        return source_element

    # current values

    def _values(self, name: str) -> list[float]:
        """Return the current numbers of an attribute."""
        numbers = self._numbers_in(self._current, Target(self._path, self._request.tag, name))
        if numbers is None:
            message = phrase("'{name}' of <{tag}> has a value that is not a number", name=name, tag=self._request.tag)
            raise EditRefusedError(Diagnostic("EDIT102", message, self._owner.span(), source=self._owner.source))
        return numbers

    def _numbers_in(self, snapshot: Snapshot, target: Target) -> list[float] | None:
        element = target.element(snapshot.root)
        if element is None or target.attribute not in element.attributes:
            if target.owner(snapshot.root) is None:
                return None
            defaults = [0.0, 0.0, 0.0] if target.attribute == "rpy" else _DEFAULT_VALUES[target.tag]
            return list(defaults)
        return parse_numbers(element.attributes[target.attribute], 4 if target.attribute == "quat_xyzw" else 3)

    def _attribute_range(self, element: Element, name: str) -> TextRange:
        """Return the range of an attribute's text, on its element or in an ``<xacro:attribute>``."""
        text_range = attribute(element, name)
        if text_range is not None:
            return text_range
        provenance = self._current.description.provenance(element) if self._current is self._first else None
        origin = (
            next((attribute for attribute in provenance.attributes if attribute.name == name), None)
            if provenance
            else None
        )
        if origin is None or origin.span is None or element.source is None or origin.span.file != element.source.name:
            raise EditRefusedError(_make_not_written_finding(element))
        source, span = element.source, origin.span
        return TextRange(source, source.offset(span.line, span.column), source.offset(span.end_line, span.end_column))


def _make_not_written_finding(element: Element) -> Diagnostic:
    message = phrase("<{tag}> cannot be edited, because no source file contains it as an element", tag=element.tag)
    hint = phrase("edit the xacro code that generates it")
    return Diagnostic("EDIT103", message, element.span(), hint=hint, source=element.source)
