"""The planning of edits: the smallest edit of the text that makes a requested change.

The texts that may determine a number are tried in turn. The plan uses the first text whose edit changes the expanded
document exactly as requested. If there is none, the edit is refused with a reason.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from itertools import islice
from math import isfinite

from linkwright.descriptions.editing.definitions import attribute
from linkwright.descriptions.editing.difference import Target, described, other_differences, path_to
from linkwright.descriptions.editing.errors import EditRefusedError
from linkwright.descriptions.editing.numbers import EXACT, numbers_of, same, shortest
from linkwright.descriptions.editing.places import Candidate, Place, literal, words
from linkwright.descriptions.editing.proposals import proposals
from linkwright.descriptions.editing.refusals import Attempt, refusal
from linkwright.descriptions.editing.request import EditRequest
from linkwright.descriptions.editing.snapshot import Snapshot
from linkwright.descriptions.service import Description
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.geometry.single import quaternion_from_rpy
from linkwright.loading.lean_dataclasses import NamedTuple, dataclass
from linkwright.xacro.faults import Frame
from linkwright.xmltree import Document, Element, Overlay, parse
from linkwright.xmltree.patches import inserted, start_tag_of

Allowed = Callable[[str], "Diagnostic | None"]
"""Why a file may not be written, by its real path; None where it may."""

_MOST_TRIALS = 60
_LEAST_SLOPE = 1e-6
_PLAIN_SLOPES = (1.0, 2.0, 0.5, 0.25)
"""For a slope other than these, 1 and -1 are factors that select a side, not lengths."""
_LARGEST = 1e6
"""Metres."""
_FEWEST = {"origin": [0.0, 0.0, 0.0], "axis": [1.0, 0.0, 0.0]}
"""The defaults of attributes that are not written."""


@dataclass(frozen=True, slots=True)
class EditPlan:
    """A planned edit.

    Attributes:
        texts: the new text of each changed file without a byte order mark, by real path; empty if nothing changes.
        before: the old texts of the same files, by real path.
        also: the names of other parts that the edit changes, if the request allows this.
    """

    texts: dict[str, str]
    before: dict[str, str]
    also: tuple[str, ...] = ()


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
    for name, wanted in planner.wanted():
        planner.set(name, wanted)
    return planner.plan()


class _Found(NamedTuple):
    """An edited description with the requested number, and the names of other changed parts."""

    snapshot: Snapshot
    also: tuple[str, ...]


class _Planner:
    """The planner of one edit, attribute by attribute and number by number.

    `_now` is the description with the edits so far.
    """

    def __init__(self, description: Description, request: EditRequest, allowed: Allowed) -> None:
        self._request, self._allowed = request, allowed
        self._now = self._first = Snapshot.of(description)
        robot = description.robot
        owner = None if robot is None else request.owner(robot)
        path = None if owner is None else path_to(self._now.root, owner)
        if owner is None or path is None or description.name.startswith("<"):
            message = phrase("'{name}' has no {part} to edit", part=request.part, name=request.name)
            raise EditRefusedError(Diagnostic("EDIT101", message, hint=phrase("the description may have changed")))
        self._path, self._owner = path, owner
        self._also_changed: dict[str, None] = {}

    def wanted(self) -> Iterator[tuple[str, list[float]]]:
        """Yield the name of each attribute to edit, with its requested numbers."""
        request = self._request
        for given in (request.xyz, request.rpy):
            if given is not None and not all(isfinite(value) and abs(value) <= _LARGEST for value in given):
                raise EditRefusedError(
                    Diagnostic("EDIT102", phrase("these numbers are not finite, or too large for a robot"))
                )
        if request.xyz is not None:
            if request.tag == "axis" and not any(abs(value) > EXACT for value in request.xyz):
                message = phrase("an axis needs a direction: 0 0 0 has none")
                raise EditRefusedError(Diagnostic("EDIT102", message))
            yield "xyz", list(request.xyz)
        element = self._owner.first(request.tag)
        if request.rpy is not None and element is not None and "quat_xyzw" in element.attributes:
            roll, pitch, yaw = request.rpy
            yield "quat_xyzw", list(quaternion_from_rpy((roll, pitch, yaw)))
        elif request.rpy is not None:
            yield "rpy", list(request.rpy)

    def set(self, name: str, wanted: list[float]) -> None:
        """Plan the edits that give an attribute the requested numbers."""
        present = self._values(name)
        changed = [i for i, (old, new) in enumerate(zip(present, wanted, strict=True)) if not same(old, new)]
        if not changed:
            return
        target = Target(self._path, self._request.tag, name)
        element = target.element(self._now.root)
        if element is None or name not in element.attributes:
            self._add(target, wanted)
            return
        place = self._written(element, name)
        parts = words(place)
        if len(parts) == len(wanted) and all(literal(parts[i]) for i in changed) and len(changed) > 1:
            together = self._edit_together(target, place, parts, {i: wanted[i] for i in changed})
            if together is not None:
                self._now = together
                return
        for i in changed:
            self._set_one(target, i, wanted[i])

    def plan(self) -> EditPlan:
        """Return the plan of all edits."""
        texts = {str(path): text for path, text in self._now.texts.items()}
        before = {path: Overlay().read(path).text for path in texts}
        return EditPlan(texts, before, tuple(self._also_changed))

    # one number

    def _set_one(self, target: Target, index: int, wanted: float) -> None:
        element = target.element(self._now.root)
        assert element is not None, "it has the attribute"
        place = self._written(element, target.attribute)
        present = self._values(target.attribute)
        frame = element.origin if isinstance(element.origin, Frame) else None
        attempts: list[Attempt] = []
        offered = proposals(
            place, index, frame, self._now.definitions, present=present, is_angle=target.attribute == "rpy"
        )
        best: _Found | None = None
        least = (0, False)
        for candidate in islice(offered, _MOST_TRIALS):
            found = self._try_candidate(candidate, target, index, wanted, attempts)
            if found is None:
                continue
            if not found.also:
                best = found
                break
            reach = len(found.also), candidate.is_choice
            if best is None or reach < least:
                best, least = found, reach
        if best is not None:
            self._now = best.snapshot
            self._also_changed.update(dict.fromkeys(best.also))
            return
        raise EditRefusedError(refusal(place, index, attempts))

    def _try_candidate(
        self, candidate: Candidate, target: Target, index: int, wanted: float, attempts: list[Attempt]
    ) -> _Found | None:
        """Return the description edited through a candidate, or None if the edit is not suitable.

        The reason for a failure is appended to `attempts`.
        """
        why_not = self._allowed(os.path.realpath(candidate.place.source.name))
        if why_not is not None:
            attempts.append(Attempt(candidate.place, forbidden=why_not))
            return None
        present = self._values(target.attribute)[index]
        guess, tolerance = candidate.value + wanted - present, EXACT
        for _ in range(2):
            guess = float(shortest(guess, tolerance))
            trial = self._try_text(candidate.place, candidate.write(guess, tolerance))
            values = None if trial is None else self._values_in(trial, target)
            if trial is None or values is None:
                attempts.append(Attempt(candidate.place, error=True))
                return None
            change = values[index] - present
            slope = change / (guess - candidate.value) if guess != candidate.value else 0.0
            if abs(slope) < _LEAST_SLOPE:
                return None  # the text does not affect the requested number
            if candidate.is_choice and not any(same(abs(slope), plain) for plain in _PLAIN_SLOPES):
                attempts.append(Attempt(candidate.place, choice=True))
                return None
            also = self._side_effects(trial, target, index, values)
            if also and not self._request.together:
                attempts.append(Attempt(candidate.place, also=also, doubtful=candidate.is_choice))
                return None
            if same(values[index], wanted):
                return _Found(trial, also)
            guess, tolerance = candidate.value + (wanted - present) / slope, EXACT / abs(slope) / 2
        attempts.append(Attempt(candidate.place))
        return None

    def _edit_together(
        self, target: Target, place: Place, parts: list[Place], new: dict[int, float]
    ) -> Snapshot | None:
        """Return the description after one edit of several literal numbers in an attribute.

        The result is None if other parts would change, too.
        """
        if self._allowed(os.path.realpath(place.source.name)) is not None:
            return None
        text, at = "", place.start
        for i, part in enumerate(parts):
            text += place.source.text[at : part.start] + (shortest(new[i]) if i in new else part.text)
            at = part.end
        text += place.source.text[at : place.end]
        trial = self._try_text(place, text)
        values = None if trial is None else self._values_in(trial, target)
        if trial is None or values is None:
            return None
        wanted = [new.get(i, value) for i, value in enumerate(self._values(target.attribute))]
        exact = all(map(same, values, wanted)) and not self._differences(trial, target)
        return trial if exact else None

    def _try_text(self, place: Place, text: str) -> Snapshot | None:
        try:
            return self._now.with_text(place, text)
        except LinkwrightError:
            return None

    def _side_effects(self, trial: Snapshot, target: Target, index: int, values: list[float]) -> tuple[str, ...]:
        """Return the names of the other parts that a trial edit changes."""
        found = self._differences(trial, target)
        present = self._values(target.attribute)
        if any(values[i] != present[i] for i in range(len(values)) if i != index):
            found.append(phrase("another number of the same attribute"))
        return tuple(dict.fromkeys(found))

    def _differences(self, trial: Snapshot, target: Target) -> list[str]:
        return [described(trail) for trail in other_differences(self._now.root, trial.root, target)]

    # missing attributes

    def _add(self, target: Target, wanted: list[float]) -> None:
        """Plan the addition of a missing attribute or element."""
        element = target.element(self._now.root)
        place, text = self._new_text(target, element, " ".join(map(shortest, wanted)))
        why_not = self._allowed(os.path.realpath(place.source.name))
        if why_not is not None:
            raise EditRefusedError(why_not)
        trial = self._try_text(place, text)
        values = None if trial is None else self._values_in(trial, target)
        also = () if trial is None else tuple(dict.fromkeys(self._differences(trial, target)))
        if also and self._request.together:
            self._also_changed.update(dict.fromkeys(also))
            also = ()
        if trial is None or values is None or not all(map(same, values, wanted)) or also:
            raise EditRefusedError(refusal(place, None, [Attempt(place, also=also, error=not also)], tag=target.tag))
        self._now = trial

    def _new_text(self, target: Target, element: Element | None, text: str) -> tuple[Place, str]:
        if element is not None:
            written = self._source_element(element)
            tag = start_tag_of(written)
            if tag is not None and written.source is not None:
                return Place(written.source, tag.room, tag.room), f' {target.attribute}="{text}"'
            raise EditRefusedError(_not_written(element))
        owner = target.owner(self._now.root)
        assert owner is not None, "it was found before"
        written = self._source_element(owner)
        new = Element(target.tag, {target.attribute: text})
        after = None
        if target.tag == "axis":
            after = next((element for tag in ("child", "parent", "origin") for element in written.elements(tag)), None)
        edit = inserted(written, [new], after=after, first=after is None)
        if edit is None or written.source is None:
            raise EditRefusedError(_not_written(owner))
        return Place(written.source, edit.start, edit.end), edit.text

    def _source_element(self, element: Element) -> Element:
        """Return the unexpanded element in the file for an element of the expansion."""
        if element.source is None:
            raise EditRefusedError(_not_written(element))
        document: Document = parse(element.source.text, element.source.name)
        found = next((child for child in document.root.walk() if child.offset == element.offset), None)
        if found is None:
            raise EditRefusedError(_not_written(element))
        return found

    # current values

    def _values(self, name: str) -> list[float]:
        """Return the current numbers of an attribute."""
        found = self._values_in(self._now, Target(self._path, self._request.tag, name))
        if found is None:
            message = phrase("'{name}' of <{tag}> has a value that is not a number", name=name, tag=self._request.tag)
            raise EditRefusedError(Diagnostic("EDIT102", message, self._owner.span(), source=self._owner.source))
        return found

    def _values_in(self, snapshot: Snapshot, target: Target) -> list[float] | None:
        element = target.element(snapshot.root)
        if element is None or target.attribute not in element.attributes:
            if target.owner(snapshot.root) is None:
                return None
            missing = [0.0, 0.0, 0.0] if target.attribute == "rpy" else _FEWEST[target.tag]
            return list(missing)
        return numbers_of(element.attributes[target.attribute], 4 if target.attribute == "quat_xyzw" else 3)

    def _written(self, element: Element, name: str) -> Place:
        """Return the range of an attribute's text, on its element or in an ``<xacro:attribute>``."""
        place = attribute(element, name)
        if place is not None:
            return place
        provenance = self._now.description.provenance(element) if self._now is self._first else None
        origin = (
            next((attribute for attribute in provenance.attributes if attribute.name == name), None)
            if provenance
            else None
        )
        if origin is None or origin.span is None or element.source is None or origin.span.file != element.source.name:
            raise EditRefusedError(_not_written(element))
        source, span = element.source, origin.span
        return Place(source, source.offset(span.line, span.column), source.offset(span.end_line, span.end_column))


def _not_written(element: Element) -> Diagnostic:
    message = phrase("<{tag}> is not written as a separate element in a file", tag=element.tag)
    return Diagnostic("EDIT103", message, element.span(), source=element.source)
