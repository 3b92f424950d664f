"""What is implausible about the masses and inertias of links."""

from __future__ import annotations

from linkwright.descriptions import Description
from linkwright.diagnostics import Diagnostic, Severity, translated
from linkwright.lint import Finding, Settings, Subject
from linkwright.lint.registry import all_rules
from linkwright.lint.suppression import Suppressions
from linkwright.packages import PackageFinder
from linkwright.urdf import Reading, Robot
from linkwright.viewer.protocol.description import InertiaFinding
from linkwright.xmltree import Document

_RULES = "LW3"
"""The rules about masses and inertias."""


def implausible(robot: Robot, finder: PackageFinder) -> list[InertiaFinding]:
    """What the rules about masses and inertias have to say of each link.

    The links of a macro that is called four times are four links here, where `linkwright check` reports one place. May
    take long, for meshes are read to see how large links are.
    """
    if robot.element is None:
        return []
    source = robot.element.source
    name = source.name if source else robot.name
    description = Description(name, Document(robot.element, source), Reading(robot, ()))
    subject = Subject(description, finder, Settings())
    rules = [rule for rule in all_rules() if rule.default and rule.code.startswith(_RULES)]
    found = [diagnostic for rule in rules for diagnostic in rule.check(subject)]
    kept = Suppressions(subject, subject.settings).apply(found)
    owners = _owners(robot)
    return [
        InertiaFinding(link, each.code, each.message, each.hint or "")
        for each in translated([each for each in kept if each.severity is not Severity.INFO])
        if (link := _link_of(each, owners)) is not None
    ]


def _owners(robot: Robot) -> dict[int, str]:
    """Identity of every element inside of a link -> the link."""
    owners: dict[int, str] = {}
    for link in robot.links.values():
        if link.element is not None:
            owners.update((id(element), link.name) for element in link.element.walk())
    return owners


def _link_of(diagnostic: Diagnostic, owners: dict[int, str]) -> str | None:
    if not isinstance(diagnostic, Finding) or diagnostic.element is None:
        return None
    return owners.get(id(diagnostic.element))
