"""Write inferences to the source files of a description, without other changes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from linkwright.diagnostics import Diagnostic, SourceText, phrase
from linkwright.inertia.source_edits import (
    NotWritableError,
    create_edits,
    find_written_element,
    find_written_link,
)
from linkwright.inertia.writing import write_edits
from linkwright.inference.results import Inference, InferredFact
from linkwright.lint.fix import is_literal, value_edit
from linkwright.urdf import Joint, Link, Robot
from linkwright.xmltree import Element, Text
from linkwright.xmltree.patches import Replacement, make_insertion


@dataclass(frozen=True, slots=True)
class WriteResult:
    """The result of writing an inference.

    Attributes:
        files: the files that changed.
        count: the number of inferences written.
        refused: a diagnostic (DRIVE301) with the reason, for each inference that was not written.
    """

    files: tuple[Path, ...]
    count: int
    refused: tuple[Diagnostic, ...]


def write_inference(robot: Robot, inference: Inference) -> WriteResult:
    """Write an inference to the source files of a robot.

    In xacro files only literal elements are changed; an element that a macro or an expression creates is refused.

    Args:
        robot: the robot, read from a file, directly or through xacro.
        inference: the inference about the robot.

    Raises:
        LinkwrightError: INR201, a file cannot be written.
    """
    findings_by_owner: dict[int, list[InferredFact]] = {}
    for finding in inference.findings:
        if finding.owner is not None:
            findings_by_owner.setdefault(id(finding.owner), []).append(finding)
    by_key = {str(key): findings for key, findings in findings_by_owner.items()}
    writer = _Writer(robot)
    written = write_edits({key: partial(writer.create_owner_edits, findings) for key, findings in by_key.items()})
    refused = tuple(
        _create_refusal(finding, reason) for key, reason in written.refusals.items() for finding in by_key[key]
    )
    return WriteResult(written.files, sum(len(by_key[key]) for key in written.links), refused)


class _Writer:
    """A writer that determines the edits for an inference.

    Args:
        robot: the robot, read from a file, directly or through xacro.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._links = {id(link.element): link for link in robot.links.values()}
        self._joints = {id(joint.element): joint for joint in robot.joints.values()}
        elements = [link.element for link in robot.links.values()]
        elements += [joint.element for joint in robot.joints.values()]
        self._uses_by_position = Counter(_get_source_position(element) for element in elements if element is not None)

    def create_owner_edits(self, findings: list[InferredFact]) -> tuple[SourceText, list[Replacement]]:
        """Return the source text, and the edits for the findings of one owner.

        Raises:
            NotWritableError: the owner is not a literal element of a file.
        """
        owner = findings[0].owner
        assert owner is not None, "findings without an owner add nothing"
        if self._uses_by_position[_get_source_position(owner)] > 1:
            raise NotWritableError(phrase("its text in the file defines several links or joints"))
        if id(owner) in self._links:
            return self._create_link_edits(owner, findings)
        if id(owner) in self._joints:
            return self._create_joint_edits(owner, findings)
        return self._create_root_edits(owner, findings)

    def _create_link_edits(self, owner: Element, findings: list[InferredFact]) -> tuple[SourceText, list[Replacement]]:
        link = self._links[id(owner)]
        source_link = find_written_link(link)
        source = _get_source_text(source_link)
        changes: list[Replacement] = []
        added: list[Element] = []
        for finding in findings:
            if finding.inertial is not None and source_link.children:
                changes += create_edits(link, finding.inertial)[1]
            else:
                added += finding.added
        return source, [*changes, *_insert_elements(source_link, added)]

    def _create_joint_edits(self, owner: Element, findings: list[InferredFact]) -> tuple[SourceText, list[Replacement]]:
        source_element = find_written_element(owner, "joint")
        source = _get_source_text(source_element)
        (axis,) = (element for finding in findings for element in finding.added)
        old_axis = source_element.first("axis")
        if old_axis is None:
            return source, list(_insert_elements(source_element, [axis]))
        edit = value_edit(old_axis, "xyz", axis.attributes["xyz"]) if is_literal(old_axis, "xyz") else None
        if edit is None:
            raise NotWritableError(phrase("its <axis> is written with expressions"))
        return source, [Replacement(edit.start, edit.end, edit.replacement)]

    def _create_root_edits(self, owner: Element, findings: list[InferredFact]) -> tuple[SourceText, list[Replacement]]:
        source_element = find_written_element(owner, owner.tag)
        added = [element for finding in findings for element in finding.added]
        for name in sorted(_find_possible_names(added)):
            joint_or_link: Joint | Link | None = self._robot.joints.get(name) or self._robot.links.get(name)
            if joint_or_link is not None and (
                joint_or_link.element is None or not is_literal(joint_or_link.element, "name")
            ):
                raise NotWritableError(phrase("the referenced name '{name}' comes from an expression", name=name))
        return _get_source_text(source_element), list(_insert_elements(source_element, added))


def _find_possible_names(elements: Iterable[Element]) -> set[str]:
    """Return the texts in elements that may be link and joint names."""
    names: set[str] = set()
    for element in elements:
        for descendant in element.walk():
            names |= {value for name, value in descendant.attributes.items() if name in ("reference", "link")}
            names |= {child.data for child in descendant.children if isinstance(child, Text)}
    return names


def _insert_elements(owner: Element, added: list[Element]) -> Iterator[Replacement]:
    """Yield the edit that inserts elements at the end of an element in a file."""
    if not added:
        return
    edit = make_insertion(owner, added)
    if edit is None:
        raise NotWritableError(phrase("it is not written in a file"))
    yield edit


def _get_source_text(element: Element) -> SourceText:
    assert element.source is not None, "it was read from a file"
    return element.source


def _get_source_position(element: Element) -> tuple[str, int]:
    return ("", id(element)) if element.source is None else (element.source.name, element.offset)


def _create_refusal(finding: InferredFact, reason: str) -> Diagnostic:
    diagnostic = finding.diagnostic
    message = phrase(
        "an inferred element is not written to the file, because {reason}: {element}",
        element=diagnostic.message,
        reason=reason,
    )
    hint = phrase("edit the macro or the expression; `linkwright drive FILE --show` prints the text")
    return Diagnostic("DRIVE301", message, diagnostic.span, hint=hint, source=diagnostic.source)
