"""Messages about errors in SDF elements, derived from the rules of the elements."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import Any

from linkwright.diagnostics import Note, Phrase, Severity, counted, did_you_mean, joined, nearest, phrase, term
from linkwright.schema import UNREADABLE, AttributeRule, ElementRule
from linkwright.sdf.poses import WORLD
from linkwright.sdf.unread import find_allowed_parents
from linkwright.sdf.values import (
    INTEGER,
    NUMBER,
    NUMBER_COUNTS,
    TIME,
    TRUTH,
    VECTOR2,
    VECTOR3,
    parse_leading_number,
    parse_leading_numbers,
    parse_numbers,
)
from linkwright.urdf.report import Findings
from linkwright.urdf.values import number_hint, vector_hint
from linkwright.xmltree import Element

NEWEST_VERSION = (1, 12)
"""The newest supported version of SDF. Older files are read with its rules, as in libsdformat."""


def describe_element(element: Element) -> Phrase:
    """Return the description of an element for messages, such as ``link 'chassis'``."""
    name = element.attributes.get("name")
    if name is None:
        return phrase("<{tag}>", tag=element.tag)
    return phrase("{tag} '{name}'", tag=term(element.tag), name=name)


class SdfReport(Findings):
    """A report that collects the findings on one document, and formulates their messages."""

    __slots__ = ("_misspelled", "is_of_classic")

    def __init__(self) -> None:
        super().__init__(NEWEST_VERSION)
        self.is_of_classic = False
        """Whether the SDF version is older than 1.7. Gazebo classic accepts more than newer libsdformat."""
        self._misspelled: list[Element] = []

    def missing_attribute(self, element: Element, rule: ElementRule, attribute: AttributeRule, owner: Element) -> None:
        """Report a missing required attribute, or an empty element whose text is required."""
        if attribute is rule.text:
            message = phrase("<{tag}> of {owner} is empty", tag=rule.tag, owner=describe_element(owner))
            self.error("SDF120", message, element, hint=phrase("write <{tag}>...</{tag}>", tag=rule.tag))
            return
        values = {"tag": rule.tag, "name": attribute.name}
        unknown_names = [name for name in element.attributes if name not in rule.attribute_rules]
        similar_names = nearest(attribute.name, unknown_names, limit=1)
        hint = phrase('add {name}="..."', name=attribute.name)
        if similar_names:
            hint = phrase(
                "did you mean '{name}' instead of '{similar}'?", name=attribute.name, similar=similar_names[0]
            )
        if owner is element or owner.attributes.get("name") is None:
            message = phrase("<{tag}> has no '{name}'", **values)
        else:
            message = phrase("<{tag}> of {owner} has no '{name}'", **values, owner=describe_element(owner))
        self.error("SDF120", message, element, hint=hint)

    def malformed(self, element: Element, rule: ElementRule, attribute: AttributeRule, owner: Element) -> Any:
        """Report an invalid value, and return the value to use, or ``UNREADABLE`` for the default.

        For a number or a vector, libsdformat reads the start of the text and ignores the rest. If this gives a value,
        return it and report a warning.
        """
        is_text = attribute is rule.text
        text = element.text().strip() if is_text else element.attributes[attribute.name]
        message, hint = _explain_value(_describe_location(element, rule, attribute, owner), text, attribute, element)
        number = parse_leading_number(text) if attribute.type in (NUMBER, INTEGER) else None
        if number is not None and isfinite(number):
            self.warning("SDF121", message, element, None if is_text else attribute.name, hint=hint)
            return int(number) if attribute.type is INTEGER else number
        if attribute.type in (VECTOR2, VECTOR3) and (
            vector := parse_leading_numbers(text, NUMBER_COUNTS[attribute.type])
        ):
            self.warning("SDF121", message, element, None if is_text else attribute.name, hint=hint)
            return vector
        if (
            self.is_of_classic
            and attribute.type in NUMBER_COUNTS
            and (completed_text := _append_zeros(text, NUMBER_COUNTS[attribute.type]))
        ):
            note = Note(phrase("Gazebo classic reads missing numbers as 0, but newer Gazebo versions reject the file"))
            self.warning("SDF121", message, element, None if is_text else attribute.name, notes=(note,), hint=hint)
            return attribute.type.read(completed_text)
        self.error("SDF121", message, element, None if is_text else attribute.name, hint=hint)
        return UNREADABLE

    def too_new(self, element: Element, rule: ElementRule, attribute: AttributeRule, owner: Element) -> None:
        """Raise an AssertionError, because no element is too new for the newest rules.

        All files are read with the newest rules.
        """
        raise AssertionError(f"{rule.tag} {attribute.name} is for some versions only")

    def missing_child(self, element: Element, rule: ElementRule, child: ElementRule, owner: Element) -> None:
        """Report a missing required child element."""
        candidates = [child for child in element.elements() if child.tag not in rule.child_rules]
        similar_tags = nearest(child.tag, [candidate.tag for candidate in candidates], limit=1)
        misspelled = next((candidate for candidate in candidates if candidate.tag in similar_tags), None)
        hint = phrase("add <{tag}>...</{tag}>", tag=child.tag)
        if misspelled is not None:
            hint = phrase("did you mean '{name}' instead of '{similar}'?", name=child.tag, similar=misspelled.tag)
            self._misspelled.append(misspelled)
        self.error(
            "SDF130",
            phrase("{element} has no <{tag}>", element=describe_element(element), tag=child.tag),
            misspelled or element,
            hint=hint,
        )

    def empty_choice(self, element: Element, rule: ElementRule, owner: Element) -> None:
        """Raise an AssertionError: in SDF, no element's first child determines its meaning."""
        raise AssertionError(rule.tag)

    def unknown_choice(self, child: Element, rule: ElementRule, owner: Element) -> None:
        """Raise an AssertionError: in SDF, no element's first child determines its meaning."""
        raise AssertionError(rule.tag)

    def unknown_elements(self, elements: Sequence[Element], rule: ElementRule, harmless: Sequence[bool]) -> None:
        """Report the child elements of one parent that have no rule.

        Misspelled, misplaced and harmless elements are reported separately, and all others in one finding.

        Args:
            elements: the child elements without a rule.
            rule: the rule of the parent.
            harmless: for each element, whether reading it would make no difference; such an element is reported as
                information, unless it is misspelled.
        """
        known_tags = [child.tag for child in rule.children]
        unexplained: list[Element] = []
        for element, is_harmless in zip(elements, harmless, strict=True):
            if any(element is child for child in self._misspelled):
                continue
            hint = did_you_mean(element.tag, known_tags)
            if hint is None and is_harmless:
                self._unread([element], rule, severity=Severity.INFO)
                continue
            if hint is None:
                parent_tags = [
                    f"<{parent_tag}>" for parent_tag in find_allowed_parents(element.tag) if parent_tag != rule.tag
                ]
                hint = phrase("put it directly in {tags}", tags=" or ".join(parent_tags)) if parent_tags else None
            if hint is not None:
                self._unread([element], rule, hint)
            else:
                unexplained.append(element)
        if unexplained:
            self._unread(unexplained, rule)

    def _unread(
        self,
        elements: Sequence[Element],
        rule: ElementRule,
        hint: Phrase | None = None,
        severity: Severity = Severity.WARNING,
    ) -> None:
        tags = list(dict.fromkeys(element.tag for element in elements))
        message = phrase("<{tag}> in <{parent}> is not read", tag=tags[0], parent=rule.tag)
        if tags[1:]:
            message = phrase(
                "{tags} in <{parent}> are not read", tags=joined([f"<{tag}>" for tag in tags]), parent=rule.tag
            )
        self._add(severity, "SDF150", message, elements[0], None, hint, ())

    def reserved(self, element: Element, name: str) -> None:
        """Report an element whose name is reserved."""
        message = phrase("a {kind} cannot be named '{name}'", name=name, kind=term(element.tag))
        if element.tag == name == WORLD:
            hint = phrase("Gazebo classic accepts this name, but gz rejects it; use a name such as 'default'")
            self.warning("SDF111", message, element, "name", hint=hint)
            return
        hint = phrase("choose another name: '::' separates names, and SDF reserves 'world' and '__...__'")
        self.error("SDF111", message, element, "name", hint=hint)

    def twice(self, element: Element, first: Element) -> None:
        """Report an element that has the same name as an earlier sibling."""
        notes: Sequence[Note] = (Note(phrase("first defined here"), first.span()),)
        message = phrase("two elements of the same parent are named '{name}'", name=element.attributes.get("name", ""))
        if element.tag == first.tag:
            kind = element.tag
            message = phrase(
                "{kind} '{name}' is defined twice", kind=term(kind), name=element.attributes.get("name", "")
            )
        is_accepted = self.is_of_classic and {element.tag, first.tag} == {"link", "joint"}  # libsdformat's Model::Load
        severity = Severity.WARNING if is_accepted else Severity.ERROR
        self._add(severity, "SDF110", message, element, "name", phrase("give each of them a different name"), notes)


def _append_zeros(text: str, count: int) -> str:
    """Return a text with zeros appended for missing numbers.

    The result is empty if no number is missing or a number is invalid.
    """
    try:
        values = parse_numbers(text)
    except ValueError:
        return ""
    return f"{text} {'0 ' * (count - len(values))}" if 0 < len(values) < count else ""


def _describe_location(element: Element, rule: ElementRule, attribute: AttributeRule, owner: Element) -> Phrase:
    """Return a description of a value's location for messages.

    Examples are ``<mass> of link 'arm'`` and ``'type' of joint 'elbow'``.
    """
    if "name" in element.attributes:
        return phrase("'{name}' of {owner}", name=attribute.name, owner=describe_element(element))
    location = phrase("<{tag}>", tag=rule.tag)
    if attribute is not rule.text:
        location = phrase("'{name}' in <{tag}>", name=attribute.name, tag=rule.tag)
    return (
        location
        if owner is element
        else phrase("{value_name} of {owner}", value_name=location, owner=describe_element(owner))
    )


def _explain_value(
    subject: Phrase, text: str, attribute: AttributeRule, element: Element
) -> tuple[Phrase, Phrase | None]:
    """Return the message and the hint, or None, for an invalid value of an attribute."""
    values = {"subject": subject, "value": text}
    if attribute.type in NUMBER_COUNTS:
        return _explain_numbers(values, text, NUMBER_COUNTS[attribute.type], element)
    if attribute.type is TRUTH:
        return phrase("{subject} must be true or false, not '{value}'", **values), phrase("write true or false")
    if attribute.type in (NUMBER, TIME):
        return phrase("{subject} is not a number: '{value}'", **values), number_hint(text)
    if attribute.type is INTEGER:
        return phrase("{subject} is not an integer: '{value}'", **values), None
    words = attribute.type.name.split(" | ")
    hint = did_you_mean(text, words) or phrase("choose from {names}", names=joined(words))
    return phrase("{subject} has an unsupported value: '{value}'", **values), hint


def _explain_numbers(values: dict[str, Any], text: str, count: int, element: Element) -> tuple[Phrase, Phrase | None]:
    is_quaternion = element.attributes.get("rotation_format") == "quat_xyzw"
    count += is_quaternion
    try:
        found_count = len(parse_numbers(text))
    except ValueError:
        return phrase("{subject} is not {count} numbers: '{value}'", **values, count=count), vector_hint(text, count)
    if found_count == count and not all(map(isfinite, parse_numbers(text))):
        return phrase("{subject} is not {count} numbers: '{value}'", **values, count=count), None
    if found_count == count:
        return phrase("the quaternion in {subject} has length zero: '{value}'", **values), phrase(
            "write 0 0 0 1 for no rotation"
        )
    message = counted(
        "{subject} has 1 number, but {expected_count} are expected: '{value}'",
        "{subject} has {count} numbers, but {expected_count} are expected: '{value}'",
        found_count,
        **values,
        expected_count=count,
    )
    return message, phrase('add rotation_format="quat_xyzw"') if found_count == 7 else None
