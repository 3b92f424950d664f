"""Reading links: inertia, shapes and materials, by urdfdom's rules.

A part of a link that cannot be read does not make urdfdom refuse the model. The link stays, without that part and
without all that comes after it in the order inertial, visuals, collisions. So does ours; the error is reported.
"""

from __future__ import annotations

from itertools import takewhile
from typing import Any

from linkwright.diagnostics import Diagnostic, Note, Phrase, joined, phrase
from linkwright.schema.reading import reader_of
from linkwright.schema.report import UNREADABLE
from linkwright.schema.rules import ElementRule, Version
from linkwright.urdf.explain import UrdfReport, owner_name
from linkwright.urdf.materials import MaterialTable
from linkwright.urdf.model import Link, Visual
from linkwright.urdf.schema import COLLISION, INERTIAL, LINK, VISUAL
from linkwright.xmltree import Element


def read_link(element: Element, materials: MaterialTable, findings: UrdfReport) -> Link:
    """A link with what could be read of it; materials defined in it become known."""
    name = element.attributes.get("name")
    if name is None:
        findings.missing_attribute(element, LINK, LINK.attributes[0], element)
        return Link("", element=element)
    errors = findings.error_count
    values = reader_of(LINK, findings.version).read(element, element, findings)
    if findings.error_count > errors:
        _drop_what_urdfdom_drops(values, findings)
    values["visuals"] = tuple(_visual(fields, materials, element) for fields in values["visuals"])
    return Link(**values)


def _drop_what_urdfdom_drops(values: dict[str, Any], findings: UrdfReport) -> None:
    """Leave only the parts before the first one that cannot be read, and say at its first error what is lost."""
    element: Element = values["element"]
    inertial = element.first("inertial")
    first_lost: tuple[ElementRule, Element] | None = None
    lost: list[Phrase] = []
    if inertial is not None and values["inertial"] is None:
        first_lost = INERTIAL, inertial
        lost.append(phrase("its <inertial>"))
    for rule in (VISUAL, COLLISION):
        found = values[rule.target]
        kept = tuple(takewhile(lambda part: part is not UNREADABLE, found)) if first_lost is None else ()
        if len(kept) < len(found):
            first_lost = first_lost or (rule, list(element.elements(rule.tag))[len(kept)])
            lost.append(phrase("{count} <{tag}>", count=len(found) - len(kept), tag=rule.tag))
        values[rule.target] = kept
    if first_lost is not None:
        note = phrase("{owner} is left without {lost}, as in urdfdom", owner=owner_name(element), lost=joined(lost))
        findings.annotate(_first_error(*first_lost, element, findings.version), Note(note))


def _first_error(rule: ElementRule, part: Element, owner: Element, version: Version) -> Diagnostic:
    """The error that urdfdom stops at, which goes through the children of a part in the order of the rule."""
    for child in rule.children:
        alone = UrdfReport(version)
        element = part.first(child.tag)
        if element is not None:
            reader_of(child, version).read(element, owner, alone)
        elif child.required:
            alone.missing_child(part, rule, child, owner)
        if alone.error_count:
            return alone.first_error()
    raise AssertionError("a part that cannot be read has an error")


def _visual(fields: dict[str, Any], materials: MaterialTable, owner: Element) -> Visual:
    own = fields["material"]
    if own is not None:
        fields["material_name"] = own.name
        fields["material"] = materials.resolve(own, owner)
    return Visual(**fields)
