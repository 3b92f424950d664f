"""Rules about elements that URDF readers ignore: misspelled, misplaced or unknown ones."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.lint.fix import rename_element
from linkwright.lint.rule import Rule
from linkwright.lint.structure import SchemaElement
from linkwright.lint.subject import Subject
from linkwright.lint.unknown_names import (
    INNER_EXTENSIONS,
    PARENT_TAGS,
    describe_location,
    find_intended_element,
    find_reader_hints,
    is_expected_element,
    is_misspelled,
)
from linkwright.lint.walk import parse_numbers
from linkwright.urdf import schema
from linkwright.xmltree import Element


class MisspelledElement(Rule):
    """A misspelled URDF element.

    ## Why

    urdfdom silently ignores every unknown element: `<inertail>` leaves the link without inertia.

    ## Example

    ```xml
    <link name="arm">
      <inertail> ... </inertail>
    </link>
    ```

    ## Use instead

    ```xml
      <inertial> ... </inertial>
    ```
    """

    code = "LW104"
    name = "misspelled-element"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every unread element that probably misspells an element allowed in its parent."""
        reported_spans = find_reader_hints(subject)
        for schema_element, child in subject.structure.unknown_elements:
            intended = find_intended_element(schema_element.rule, child)
            if intended is None or child.span() in reported_spans:
                continue
            yield self.report(
                phrase("<{tag}> in {parent} is not read", tag=child.tag, parent=describe_location(schema_element)),
                child,
                hint=phrase("did you mean <{tag}>?", tag=intended),
                fix=rename_element(child, intended, safe=False) if is_misspelled(child.tag, intended) else None,
            )


class MisplacedElement(Rule):
    """An element of URDF in a place where it is not read.

    ## Why

    urdfdom silently ignores a misplaced element. An `<origin>` inside `<geometry>` does not move the shape, and a
    `<mass>` directly in a link does not give the link a mass.

    ## Example

    ```xml
    <visual>
      <geometry>
        <box size="1 1 1"/>
        <origin xyz="0 0 0.5"/>
      </geometry>
    </visual>
    ```

    ## Use instead

    ```xml
    <visual>
      <origin xyz="0 0 0.5"/>
      <geometry><box size="1 1 1"/></geometry>
    </visual>
    ```
    """

    code = "LW105"
    name = "misplaced-element"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report unread URDF elements that other parents allow.

        Elements without an effect, and elements that the URDF reader reports, are left out.
        """
        reported_spans = find_reader_hints(subject)
        for schema_element, child in subject.structure.unknown_elements:
            parent_tags = PARENT_TAGS.get(child.tag, ())
            if (
                not parent_tags
                or child.span() in reported_spans
                or (schema_element.rule.tag, child.tag) == ("collision", "material")
            ):
                continue
            if child.tag == "origin" and _is_zero(child):
                continue
            parents_text = " or ".join(f"<{tag}>" for tag in _find_nearest_parents(parent_tags, schema_element))
            yield self.report(
                phrase("<{tag}> in {parent} is not read", tag=child.tag, parent=describe_location(schema_element)),
                child,
                hint=phrase("put it directly in {tags}", tags=parents_text),
            )


def _is_zero(origin: Element) -> bool:
    """Return whether an origin is zero, so that it would have no effect even if it were read."""
    return not any(float(value) for name in ("xyz", "rpy") for value in parse_numbers(origin, name))


def _find_nearest_parents(parent_tags: Sequence[str], schema_element: SchemaElement) -> Sequence[str]:
    """Return the allowed parents of a misplaced element that are closest to its current parent.

    The closest parents are children of the current parent, then the parent of the current parent, then all allowed
    parents.
    """
    outer_tag = schema_element.parent.tag if schema_element.parent is not None else ""
    child_tags = [tag for tag in parent_tags if tag in schema_element.rule.child_rules]
    return child_tags or ((outer_tag,) if outer_tag in parent_tags else parent_tags)


class UnknownElement(Rule):
    """An element inside a link or joint that URDF does not define, such as one of SDF.

    ## Why

    urdfdom ignores the element, so it does not have the intended effect. For example, SDF's `<max_contacts>` has no
    effect in a `<collision>`. Elements directly in `<robot>` are not reported. Neither are names that do not occur in
    any format related to URDF, such as those for a vendor's software.

    ## Example

    ```xml
    <link name="arm">
      <weight>3</weight>
    </link>
    ```

    ## Use instead

    Remove the element, or move it into a `<gazebo reference="arm">` if a simulator should read it.
    """

    code = "LW107"
    name = "unknown-element"
    holds_for_parts = True
    severity = Severity.INFO

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every unread element that the other rules do not report."""
        reported_spans = find_reader_hints(subject)
        for schema_element, child in subject.structure.unknown_elements:
            if schema_element.rule is schema.ROBOT or child.tag in INNER_EXTENSIONS or child.tag in PARENT_TAGS:
                continue
            if not is_expected_element(child.tag):
                continue
            if find_intended_element(schema_element.rule, child) is None and child.span() not in reported_spans:
                allowed = ", ".join(f"<{rule.tag}>" for rule in schema_element.rule.children)
                yield self.report(
                    phrase("<{tag}> in {parent} is not read", tag=child.tag, parent=describe_location(schema_element)),
                    child,
                    hint=phrase("use only {known} here", known=allowed)
                    if allowed
                    else phrase("<{tag}> has no child elements", tag=schema_element.rule.tag),
                )


class MaterialInCollision(Rule):
    """A `<collision>` with a `<material>`.

    ## Why

    Collision shapes have no color, so the material is not read. A material that is defined only in a collision cannot
    be used elsewhere. Some macros write the same content for visuals and collisions, which is harmless, so the rule is
    off by default.

    ## Example

    ```xml
    <collision>
      <geometry><box size="1 1 1"/></geometry>
      <material name="red"/>
    </collision>
    ```

    ## Use instead

    Write the `<material>` in the `<visual>`.
    """

    code = "LW110"
    name = "material-in-collision"
    holds_for_parts = True
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every material of a collision."""
        from linkwright.lint.fix import remove_element

        for schema_element in subject.structure.schema_elements:
            if schema_element.rule.tag == "collision":
                for material in schema_element.element.elements("material"):
                    yield self.report(
                        phrase("<material> in {parent} is not read", parent=schema_element),
                        material,
                        hint=phrase("write it in the <visual>"),
                        fix=remove_element(material),
                    )
