"""The reader's messages about missing, malformed and misplaced parts of URDF."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.diagnostics import (
    Diagnostic,
    Note,
    Phrase,
    Severity,
    counted,
    did_you_mean,
    joined,
    nearest,
    phrase,
    quoted,
    term,
)
from linkwright.loading.lean_typing import Any
from linkwright.schema.reading import UNREADABLE
from linkwright.schema.rules import AttributeRule, ElementRule, Version
from linkwright.urdf.values import (
    JOINT_TYPE,
    JOINT_TYPES,
    NUMBER,
    NUMBER_COUNTS,
    RGBA,
    TEXT,
    number_hint,
    numbers,
    vector_hint,
)
from linkwright.xmltree import Element


class Findings:
    """The findings of one reading, and whether they make urdfdom refuse the robot.

    Attributes:
        version: the URDF version of the file, whose rules apply.
        rejected: whether urdfdom would refuse the model.
        count: the number of findings so far.
        error_count: the number of errors among the findings.
    """

    __slots__ = ("_diagnostics", "count", "error_count", "rejected", "version")

    def __init__(self, version: Version = (1, 0)) -> None:
        self.version = version
        self.rejected = False
        self.count = 0
        self.error_count = 0
        self._diagnostics: list[Diagnostic] = []

    def reject(
        self,
        code: str,
        message: Phrase,
        element: Element,
        attribute: str | None = None,
        *,
        hint: Phrase | None = None,
        notes: Sequence[Note] = (),
    ) -> None:
        """Report an error that makes urdfdom refuse the model."""
        self.rejected = True
        self._add(Severity.ERROR, code, message, element, attribute, hint, notes)

    def error(
        self,
        code: str,
        message: Phrase,
        element: Element,
        attribute: str | None = None,
        *,
        hint: Phrase | None = None,
        notes: Sequence[Note] = (),
    ) -> None:
        """Report an error in a part that urdfdom drops or misreads, although it accepts the model."""
        self._add(Severity.ERROR, code, message, element, attribute, hint, notes)

    def warning(
        self,
        code: str,
        message: Phrase,
        element: Element,
        attribute: str | None = None,
        *,
        hint: Phrase | None = None,
        notes: Sequence[Note] = (),
    ) -> None:
        """Report a construct that urdfdom silently accepts, although it is probably not intended."""
        self._add(Severity.WARNING, code, message, element, attribute, hint, notes)

    def duplicate(self, kind: str, name: str, element: Element, first: Element | None) -> None:
        """Report a second element of the same kind and name as `first`."""
        notes = (Note(phrase("first defined here"), first.span()),) if first else ()
        hint = phrase("give each {kind} its own name", kind=term(kind))
        self.reject(
            "URDF110",
            phrase("{kind} '{name}' is defined twice", kind=term(kind), name=name),
            element,
            "name",
            hint=hint,
            notes=notes,
        )

    def first_error(self) -> Diagnostic:
        """Return the first of at least one error."""
        return next(finding for finding in self._diagnostics if finding.severity is Severity.ERROR)

    def annotate(self, finding: Diagnostic, note: Note) -> None:
        """Add a note to the latest recorded finding that is equal to `finding`."""
        for index in range(len(self._diagnostics) - 1, -1, -1):
            if self._diagnostics[index] == finding:
                self._diagnostics[index] = finding.with_changes(notes=(*finding.notes, note))
                return

    def in_order(self) -> tuple[Diagnostic, ...]:
        """Return all findings sorted by location, with files in the order of their first findings."""
        files: dict[str, int] = {}

        def sort_key(diagnostic: Diagnostic) -> tuple[int, int, int]:
            span = diagnostic.span
            if span is None:
                return len(files), 0, 0
            return files.setdefault(span.file, len(files)), span.line, span.column

        return (
            tuple(sorted(self._diagnostics, key=sort_key)) if len(self._diagnostics) > 1 else tuple(self._diagnostics)
        )

    def _add(
        self,
        severity: Severity,
        code: str,
        message: Phrase,
        element: Element,
        attribute: str | None,
        hint: Phrase | None,
        notes: Sequence[Note],
    ) -> None:
        self.count += 1
        if severity is Severity.ERROR:
            self.error_count += 1
        span = element.attribute_span(attribute) if attribute else element.span()
        trail: tuple[Note, ...] = ()
        if element.origin is not None:
            from linkwright.xacro.faults import origin_of

            trail = origin_of(element).trail
        self._diagnostics.append(Diagnostic(code, message, span, severity, (*notes, *trail), hint, element.source))


BLACK = (0.0, 0.0, 0.0, 1.0)

_JOINT_ALIASES = {
    "hinge": "revolute",
    "rotational": "revolute",
    "rotary": "revolute",
    "rotate": "revolute",
    "wheel": "continuous",
    "linear": "prismatic",
    "slider": "prismatic",
    "sliding": "prismatic",
    "translational": "prismatic",
    "static": "fixed",
    "rigid": "fixed",
    "weld": "fixed",
    "free": "floating",
    "ball": None,
    "spherical": None,
    "universal": None,
    "screw": None,
}
_SHAPE_ALIASES = {"cube": "box", "cuboid": "box", "ball": "sphere", "tube": "cylinder", "rod": "cylinder"}


def describe_owner(owner: Element) -> Phrase:
    """Return the name of an element's owner in messages: ``joint 'elbow'``, ``the robot``."""
    name = owner.attributes.get("name")
    if owner.tag == "joint":
        return phrase("a joint without a name") if name is None else phrase("joint '{name}'", name=name)
    if owner.tag == "link":
        return phrase("link '{name}'", name=name)
    if owner.tag == "material":
        return phrase("material '{material}'", material=name or "")
    return phrase("the robot")


class UrdfReport(Findings):
    """The findings of one reading, as the generated readers report them.

    See `linkwright.schema.reading`.
    """

    __slots__ = ()

    def missing_attribute(self, element: Element, rule: ElementRule, attribute: AttributeRule, owner: Element) -> None:
        """Report that a required attribute is missing."""
        hint = _make_missing_attribute_hint(element, rule, attribute)
        if attribute.name == "name" and rule.tag == "link":
            message, hint = phrase("a link has no 'name'"), phrase('add name="..."')
        elif attribute.name == "name" and rule.tag == "joint":
            message, hint = phrase("a joint has no 'name'"), phrase('add name="..."')
        elif attribute.type is JOINT_TYPE:
            message = phrase("{owner} has no 'type'", owner=describe_owner(owner))
            hint = phrase('add type="...": {names}', names=joined(JOINT_TYPES))
        else:
            name = attribute.name
            message = phrase("<{tag}> of {owner} has no '{name}'", tag=rule.tag, owner=describe_owner(owner), name=name)
        self.error("URDF120", message, element, hint=hint)

    def malformed(self, element: Element, rule: ElementRule, attribute: AttributeRule, owner: Element) -> Any:
        """Report a malformed attribute, and return the value to use instead, or `UNREADABLE`.

        A color with a wrong count of numbers becomes black, and any other malformed color becomes None. Other
        attributes are unreadable.
        """
        name, value = attribute.name, element.attributes[attribute.name]
        fields = {"name": name, "tag": rule.tag, "owner": describe_owner(owner), "value": value}
        if attribute.type is JOINT_TYPE:
            message = phrase(
                "the type '{type}' of {owner} is not a joint type", type=value, owner=describe_owner(owner)
            )
            self.error("URDF140", message, element, name, hint=_make_joint_type_hint(value))
            return UNREADABLE
        if attribute.type is NUMBER:
            message = phrase("'{name}' in <{tag}> of {owner} is not a number: '{value}'", **fields)
            self.error("URDF121", message, element, name, hint=_make_number_hint(rule, attribute, value))
            return UNREADABLE
        count = NUMBER_COUNTS[attribute.type]
        try:
            values = numbers(value)
        except ValueError:
            message = phrase("'{name}' in <{tag}> of {owner} is not {count} numbers: '{value}'", **fields, count=count)
            self.error("URDF121", message, element, name, hint=vector_hint(value, count))
            return None if attribute.type is RGBA else UNREADABLE
        if attribute.type is RGBA:
            return self._malformed_color(element, values, owner)
        message = counted(
            "'{name}' in <{tag}> of {owner} has 1 number, but {expected} are expected: '{value}'",
            "'{name}' in <{tag}> of {owner} has {count} numbers, but {expected} are expected: '{value}'",
            len(values),
            **fields,
            expected=count,
        )
        self.error("URDF122", message, element, name, hint=_make_count_hint(rule, attribute, values))
        return UNREADABLE

    def too_new(self, element: Element, rule: ElementRule, attribute: AttributeRule, owner: Element) -> None:
        """Report that an attribute is ignored because a later version of URDF added it."""
        message = phrase(
            "'{name}' in <{tag}> of {owner} is ignored: it needs URDF {version}",
            name=attribute.name,
            tag=rule.tag,
            owner=describe_owner(owner),
            version=f"{attribute.since[0]}.{attribute.since[1]}",
        )
        hint = phrase('write <robot version="1.2" ...>')
        if attribute.name == "quat_xyzw":
            hint = phrase('write <robot version="1.1" ...>, or give rpy')
        self.warning("URDF171", message, element, attribute.name, hint=hint)

    def missing_child(
        self, element: Element, rule: ElementRule, child: ElementRule, owner: Element, kind: str = ""
    ) -> None:
        """Report that a required child is missing.

        `kind` is the type of the joint if only joints of some types need the child.
        """
        candidates = [child for child in element.elements() if child.tag not in rule.child_rules]
        similar_tags = nearest(child.tag, [candidate.tag for candidate in candidates], limit=1)
        misspelled_child = next((candidate for candidate in candidates if candidate.tag in similar_tags), None)
        hint = phrase(
            "add <{tag}/>: {meaning}", tag=f"{child.tag}{_list_usual_attributes(child)}", meaning=term(child.meaning)
        )
        if misspelled_child is not None:
            hint = phrase(
                "did you mean '{name}' instead of '{given_name}'?", name=child.tag, given_name=misspelled_child.tag
            )
        owner_text = describe_owner(owner)
        if kind:
            owner_text = phrase("{kind} {owner}", kind=kind, owner=owner_text)
        elif rule.tag not in ("link", "joint"):
            owner_text = phrase("<{tag}> of {owner}", tag=rule.tag, owner=owner_text)
        message = phrase("{owner} has no <{tag}>", owner=owner_text, tag=child.tag)
        self.error("URDF130", message, misspelled_child or element, hint=hint)

    def empty_choice(self, element: Element, rule: ElementRule, owner: Element) -> None:
        """Report that a geometry does not contain a shape."""
        assert rule.tag == "geometry"
        hint = phrase("add a box, cylinder, sphere or mesh")
        self.error("URDF131", phrase("<geometry> of {owner} is empty", owner=describe_owner(owner)), element, hint=hint)

    def unknown_choice(self, child: Element, rule: ElementRule, owner: Element) -> None:
        """Report an element in a geometry that is not a shape, or not a shape of this version."""
        if child.tag in rule.child_rules:
            hint = phrase('write <robot version="1.1" ...>, or build it from a cylinder and two spheres')
            self.error(
                "URDF132", phrase("<capsule> of {owner} needs URDF 1.1", owner=describe_owner(owner)), child, hint=hint
            )
            return
        message = phrase("<{tag}> in <geometry> of {owner} is not a shape", tag=child.tag, owner=describe_owner(owner))
        self.error("URDF132", message, child, hint=_make_shape_hint(child.tag, rule.children))

    def _malformed_color(self, color: Element, values: tuple[float, ...], material: Element) -> Any:
        text = color.attributes["rgba"]
        owner = phrase("material '{material}'", material=material.attributes.get("name", ""))
        if any(not 0 <= channel <= 1 for channel in values):
            hint = None
            if all(0 <= part <= 255 for part in values):
                scaled = [f"{part / 255:.3g}" if part > 1 else f"{part:g}" for part in values]
                hint = phrase("colors range from 0 to 1, not to 255: write '{scaled}'", scaled=" ".join(scaled))
            message = phrase("'rgba' of {owner} has a number outside 0 to 1: '{text}'", owner=owner, text=text)
            self.error("URDF123", message, color, "rgba", hint=hint)
            return None
        hint = phrase("give red, green, blue and alpha")
        if len(values) == 3:
            hint = phrase("add the alpha: '{text} 1'", text=text.strip())
        message = phrase(
            "'rgba' of {owner} has {count} numbers, but 4 are expected, so it is black: '{text}'",
            owner=owner,
            count=len(values),
            text=text,
        )
        self.warning("URDF122", message, color, "rgba", hint=hint)
        return BLACK  # urdfdom uses black without a message


def _make_number_hint(rule: ElementRule, attribute: AttributeRule, value: str) -> Phrase | None:
    if rule.tag == "limit" and attribute.usually_written and "inf" in value.casefold():
        return phrase("only finite numbers are read; a joint that turns without bounds is 'continuous'")
    return number_hint(value)


def _make_joint_type_hint(type_text: str) -> Phrase:
    """Return a hint for correcting an unknown joint type."""
    lower_case = type_text.strip().casefold()
    if lower_case in JOINT_TYPES:
        return phrase("write '{text}'", text=lower_case)
    if lower_case in _JOINT_ALIASES:
        intended = _JOINT_ALIASES[lower_case]
        if intended is None:
            return phrase("URDF has no such joint: build it from revolute joints")
        return phrase("did you mean {names}?", names=quoted(intended))
    return did_you_mean(type_text, JOINT_TYPES) or phrase("choose from {names}", names=joined(JOINT_TYPES))


def _make_shape_hint(tag: str, shapes: tuple[ElementRule, ...]) -> Phrase:
    """Return a hint for correcting an unknown shape."""
    if tag.startswith("xacro:"):
        return phrase("xacro did not evaluate this: expand the file with xacro first")
    names = [shape.tag for shape in shapes]
    intended = _SHAPE_ALIASES.get(tag.casefold())
    if intended:
        return phrase("did you mean {names}?", names=quoted(intended))
    return did_you_mean(tag, names) or phrase("choose from {names}", names=joined(names))


def _make_count_hint(rule: ElementRule, attribute: AttributeRule, values: tuple[float, ...]) -> Phrase:
    if rule.tag == "mesh" and len(values) == 1:
        return phrase("give a factor for each axis: '{value}'", value=" ".join([f"{values[0]:g}"] * 3))
    return phrase(
        "give {value}, separated by spaces: {meaning}", value=term(attribute.type.name), meaning=term(attribute.meaning)
    )


def _make_missing_attribute_hint(element: Element, rule: ElementRule, attribute: AttributeRule) -> Phrase:
    unknown_attributes = [name for name in element.attributes if name not in rule.attribute_rules]
    similar_names = nearest(attribute.name, unknown_attributes, limit=1)
    if similar_names:
        return phrase(
            "did you mean '{name}' instead of '{given_name}'?", name=attribute.name, given_name=similar_names[0]
        )
    text = element.text().strip()
    if text and not unknown_attributes and attribute.type in (TEXT, NUMBER):
        return phrase('write <{tag} {name}="{text}"/>', tag=rule.tag, name=attribute.name, text=text)
    if rule.tag == "sphere" and "diameter" in unknown_attributes:
        return phrase("give the radius, half the diameter")
    fields = {"name": attribute.name, "meaning": term(attribute.meaning)}
    if attribute.unit:
        return phrase('add {name}="...": {meaning} ({unit})', **fields, unit=term(attribute.unit))
    return phrase('add {name}="...": {meaning}', **fields)


def _list_usual_attributes(rule: ElementRule) -> str:
    return "".join(
        f' {attribute.name}="..."' for attribute in rule.attributes if attribute.required or attribute.usually_written
    )
