"""Rules about attributes that no URDF reader uses."""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics import Diagnostic, Severity, phrase, quoted
from linkwright.lint.fix import rename_attribute
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.lint.unknown_names import (
    attribute_name_span,
    find_intended_attribute,
    find_reader_hints,
    is_expected_attribute,
    is_misspelled,
)


class MisspelledAttribute(Rule):
    """A misspelled URDF attribute.

    ## Why

    urdfdom silently ignores every unknown attribute: `<limit loewr="-1" .../>` leaves the lower limit at 0, and
    `<origin rpw="0 0 1"/>` does not rotate anything.

    ## Example

    ```xml
    <origin xyz="0 0 1" rpw="0 0 1.57"/>
    ```

    ## Use instead

    ```xml
    <origin xyz="0 0 1" rpy="0 0 1.57"/>
    ```
    """

    code = "LW106"
    name = "misspelled-attribute"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every unread attribute that is probably a misspelled URDF attribute."""
        hints = find_reader_hints(subject)
        for schema_element, attribute in subject.structure.unknown_attributes:
            intended = find_intended_attribute(schema_element, attribute)
            if intended is None or f"'{attribute}'" in hints.get(schema_element.element.span(), ""):
                continue
            span = attribute_name_span(schema_element.element, attribute)
            yield self.report(
                phrase("'{attribute}' in {element} is not read", attribute=attribute, element=schema_element),
                schema_element.element,
                span=span,
                hint=phrase("did you mean {names}?", names=quoted(intended)),
                fix=rename_attribute(schema_element.element, attribute, intended, safe=False)
                if is_misspelled(attribute, intended)
                else None,
            )


class UnknownAttribute(Rule):
    """An attribute that its URDF element does not have.

    ## Why

    urdfdom ignores the attribute, so it does not have the intended effect. Attributes with a prefix, and names that do
    not occur in URDF at all, such as those for a vendor's software, are not reported.

    ## Example

    ```xml
    <axis xyz="0 0 1" rpy="0 0 0"/>
    ```

    ## Use instead

    Remove the attribute.
    """

    code = "LW108"
    name = "unknown-attribute"
    holds_for_parts = True
    severity = Severity.INFO

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every unread attribute that `MisspelledAttribute` does not report."""
        hints = find_reader_hints(subject)
        for schema_element, attribute in subject.structure.unknown_attributes:
            if not is_expected_attribute(attribute):
                continue
            if find_intended_attribute(schema_element, attribute) is not None:
                continue
            if f"'{attribute}'" in hints.get(schema_element.element.span(), ""):
                continue
            allowed = ", ".join(f"'{rule.name}'" for rule in schema_element.rule.attributes)
            yield self.report(
                phrase("'{attribute}' in {element} is not read", attribute=attribute, element=schema_element),
                schema_element.element,
                span=attribute_name_span(schema_element.element, attribute),
                hint=phrase("use only {known} here", known=allowed)
                if allowed
                else phrase("<{tag}> has no attributes", tag=schema_element.rule.tag),
            )
