"""Reasons why a link or joint that the learner wrote is not part of the robot."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, Phrase, phrase
from linkwright.learning.checks.findings import describe_finding
from linkwright.packages import PackageFinder
from linkwright.xacro import expand
from linkwright.xmltree import Element, parse_file

_UNREAD_ELEMENT_CODE = "LW105"
XML_SUFFIXES = {".xacro", ".urdf", ".xml"}


def explain_missing(path: Path, finder: PackageFinder, kind: str, name: str) -> Phrase | None:
    """Return the reason why a robot lacks a link or joint that its files contain, or None.

    Args:
        path: the file of the robot.
        finder: the finder of ROS packages.
        kind: ``link`` or ``joint``.
        name: the name of the link or joint.
    """
    try:
        sources = [source for source in expand(path, packages=finder).dependencies if source.suffix in XML_SUFFIXES]
        roots = {source: parse_file(source).root for source in sources}
        elements = [element for root in roots.values() for element in root.walk()]
        macros = {element.attributes.get("name") for element in elements if element.tag == "xacro:macro"}
        tags = {element.tag for element in elements}
        for source, root in roots.items():
            for parent, element in _iterate_with_parents(root):
                if element.tag in macros and parent.tag == "robot":
                    return _explain_missing_prefix(element, source)
                if element.tag == kind and element.attributes.get("name") == name and parent is not root:
                    return _explain_misplacement(element, parent, source)
        for macro in sorted(macro for macro in macros if macro):
            if f"xacro:{macro}" not in tags:
                return phrase("the macro '{macro}' is never called; write <xacro:{macro} .../>", macro=macro)
        return describe_unread(path)
    except LinkwrightError:
        return None


def _iterate_with_parents(element: Element) -> Iterator[tuple[Element, Element]]:
    for child in element.elements():
        yield element, child
        yield from _iterate_with_parents(child)


def _explain_misplacement(element: Element, parent: Element, path: Path) -> Phrase | None:
    line = element.source.position(element.offset)[0] if element.source else 1
    if parent.tag == "xacro:macro":
        return phrase(
            "{file}, line {line}: it is inside the macro '{macro}'; call the macro with <xacro:{macro} .../>",
            file=path.name,
            line=line,
            macro=parent.attributes.get("name", ""),
        )
    if parent.tag.startswith("xacro:"):
        return None
    return phrase(
        "{file}, line {line}: it is inside <{parent}>, but must be directly inside <robot>",
        file=path.name,
        line=line,
        parent=parent.tag,
    )


def _explain_missing_prefix(element: Element, path: Path) -> Phrase:
    line = element.source.position(element.offset)[0] if element.source else 1
    return phrase(
        "{file}, line {line}: <{tag}> does not call the macro; write <xacro:{tag} .../>",
        file=path.name,
        line=line,
        tag=element.tag,
    )


def describe_unread(path: Path) -> Phrase | None:
    """Return the first finding about an element of the file that is ignored, or None."""
    from linkwright.lint.checking import Checker
    from linkwright.lint.targets import find_targets

    findings, _ = Checker().check(find_targets([path]), [path])
    return next((describe_finding(finding) for finding in findings if finding.code == _UNREAD_ELEMENT_CODE), None)
