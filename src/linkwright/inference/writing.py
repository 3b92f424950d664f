"""Writing of inferences to the source files of a description, which leaves everything else unchanged."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from linkwright.diagnostics import Diagnostic, SourceText, phrase
from linkwright.inertia.source_edits import (
    NotWritableError,
    edits_for,
    written_element,
    written_link,
)
from linkwright.inertia.writing import write_edits
from linkwright.inference.model import Finding, Inference
from linkwright.lint.fix import is_literal, value_edit
from linkwright.urdf import Joint, Link, Robot
from linkwright.xmltree import Element, Text
from linkwright.xmltree.patches import Replacement, inserted


@dataclass(frozen=True, slots=True)
class Written:
    """The result of writing.

    Attributes:
        files: the files that changed.
        count: the number of inferences written.
        refused: a finding (DRIVE301) with the reason, for each inference that was not written.
    """

    files: tuple[Path, ...]
    count: int
    refused: tuple[Diagnostic, ...]


def write_inference(robot: Robot, inference: Inference) -> Written:
    """Write an inference to the source files of the robot.

    In xacro files only literal elements are changed; an element created by a macro or an expression is refused.

    Args:
        robot: the robot, read from a file, possibly through xacro.
        inference: the inference about the robot.

    Raises:
        LinkwrightError: INR201, a file cannot be written.
    """
    groups: dict[int, list[Finding]] = {}
    for finding in inference.findings:
        if finding.owner is not None:
            groups.setdefault(id(finding.owner), []).append(finding)
    by_key = {str(key): findings for key, findings in groups.items()}
    writer = _Writer(robot)
    done = write_edits({key: partial(writer.edits, findings) for key, findings in by_key.items()})
    refused = tuple(_refusal(finding, why) for key, why in done.refused.items() for finding in by_key[key])
    return Written(done.files, sum(len(by_key[key]) for key in done.links), refused)


class _Writer:
    """Finds the edits for an inference.

    Args:
        robot: the robot, read from a file, possibly through xacro.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._links = {id(link.element): link for link in robot.links.values()}
        self._joints = {id(joint.element): joint for joint in robot.joints.values()}
        elements = [link.element for link in robot.links.values()]
        elements += [joint.element for joint in robot.joints.values()]
        self._times = Counter(_place(element) for element in elements if element is not None)

    def edits(self, findings: list[Finding]) -> tuple[SourceText, list[Replacement]]:
        """Return the text and the edits for the findings of one owner.

        Raises:
            NotWritableError: the owner is not a literal element of a file.
        """
        owner = findings[0].owner
        assert owner is not None, "findings without an owner add nothing"
        if self._times[_place(owner)] > 1:
            raise NotWritableError(phrase("its text in the file defines several links or joints"))
        if id(owner) in self._links:
            return self._in_link(owner, findings)
        if id(owner) in self._joints:
            return self._in_joint(owner, findings)
        return self._in_root(owner, findings)

    def _in_link(self, owner: Element, findings: list[Finding]) -> tuple[SourceText, list[Replacement]]:
        link = self._links[id(owner)]
        written = written_link(link)
        source = _source(written)
        changes: list[Replacement] = []
        new: list[Element] = []
        for finding in findings:
            if finding.inertial is not None and written.children:
                changes += edits_for(link, finding.inertial)[1]
            else:
                new += finding.added
        return source, [*changes, *_inserted(written, new)]

    def _in_joint(self, owner: Element, findings: list[Finding]) -> tuple[SourceText, list[Replacement]]:
        written = written_element(owner, "joint")
        source = _source(written)
        (axis,) = (element for finding in findings for element in finding.added)
        old = written.first("axis")
        if old is None:
            return source, list(_inserted(written, [axis]))
        edit = value_edit(old, "xyz", axis.attributes["xyz"]) if is_literal(old, "xyz") else None
        if edit is None:
            raise NotWritableError(phrase("its <axis> is written with expressions"))
        return source, [Replacement(edit.start, edit.end, edit.replacement)]

    def _in_root(self, owner: Element, findings: list[Finding]) -> tuple[SourceText, list[Replacement]]:
        written = written_element(owner, owner.tag)
        new = [element for finding in findings for element in finding.added]
        for name in sorted(_named(new)):
            part: Joint | Link | None = self._robot.joints.get(name) or self._robot.links.get(name)
            if part is not None and (part.element is None or not is_literal(part.element, "name")):
                raise NotWritableError(phrase("the name '{name}' in it comes from an expression", name=name))
        return _source(written), list(_inserted(written, new))


def _named(elements: Iterable[Element]) -> set[str]:
    """Return the words of elements that may be names of links and joints."""
    found: set[str] = set()
    for element in elements:
        for inner in element.walk():
            found |= {value for name, value in inner.attributes.items() if name in ("reference", "link")}
            found |= {child.data for child in inner.children if isinstance(child, Text)}
    return found


def _inserted(owner: Element, new: list[Element]) -> Iterator[Replacement]:
    """Yield the edits that insert elements at the end of an element in a file."""
    if not new:
        return
    edit = inserted(owner, new)
    if edit is None:
        raise NotWritableError(phrase("it is not written in a file"))
    yield edit


def _source(element: Element) -> SourceText:
    assert element.source is not None, "it was read from a file"
    return element.source


def _place(element: Element) -> tuple[str, int]:
    return ("", id(element)) if element.source is None else (element.source.name, element.offset)


def _refusal(finding: Finding, why: str) -> Diagnostic:
    refused = finding.diagnostic
    message = phrase("an inferred element is not written into the file: {what}: {why}", what=refused.message, why=why)
    hint = phrase("edit the macro or the expression; `linkwright drive FILE --show` prints the text")
    return Diagnostic("DRIVE301", message, refused.span, hint=hint, source=refused.source)
