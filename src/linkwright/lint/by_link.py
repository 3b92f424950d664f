"""The findings about masses and inertias for each link of a displayed robot."""

from __future__ import annotations

from linkwright.descriptions import Description
from linkwright.diagnostics import Diagnostic, Severity
from linkwright.lint.finding import Finding
from linkwright.lint.registry import all_rules
from linkwright.lint.settings import Settings
from linkwright.lint.subject import Subject
from linkwright.lint.suppression import Suppressions
from linkwright.packages import PackageFinder
from linkwright.urdf import Reading, Robot
from linkwright.xmltree import Document

_CODE_PREFIX = "LW3"
"""The prefix of the codes of the rules about masses and inertias."""


def find_inertia_findings(robot: Robot, finder: PackageFinder) -> list[tuple[str, Diagnostic]]:
    """Return the findings about masses and inertias, each with the name of its link.

    If a macro with a link is called four times, each of the four links has its own findings, whereas `linkwright check`
    reports the location once. The function may take long because it reads meshes to measure the links.
    """
    if robot.element is None:
        return []
    source = robot.element.source
    name = source.name if source else robot.name
    description = Description(name, Document(robot.element, source), Reading(robot, ()))
    subject = Subject(description, finder, Settings())
    rules = [rule for rule in all_rules() if rule.default and rule.code.startswith(_CODE_PREFIX)]
    findings = [diagnostic for rule in rules for diagnostic in rule.check(subject)]
    link_names = _index_link_names(robot)
    return [
        (link, diagnostic)
        for diagnostic in Suppressions(subject, subject.settings).apply(findings)
        if diagnostic.severity is not Severity.INFO
        if (link := _find_link_name(diagnostic, link_names)) is not None
    ]


def _index_link_names(robot: Robot) -> dict[int, str]:
    """Return the name of the link that contains each element, by the `id` of the element."""
    link_names: dict[int, str] = {}
    for link in robot.links.values():
        if link.element is not None:
            link_names.update((id(element), link.name) for element in link.element.walk())
    return link_names


def _find_link_name(diagnostic: Diagnostic, link_names: dict[int, str]) -> str | None:
    if not isinstance(diagnostic, Finding) or diagnostic.element is None:
        return None
    return link_names.get(id(diagnostic.element))
