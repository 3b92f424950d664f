"""Rules about leftovers: unevaluated expressions, stray texts, and empty names."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import PurePath

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.urdf.values import TEXT
from linkwright.xmltree import Text


class XacroInUrdf(Rule):
    """A xacro expression in an attribute of plain URDF.

    ## Why

    The expression is not evaluated. For example, tools search for the mesh in a folder named `$(find my_robot)`.

    ## Example

    ```xml
    <robot name="r">
      ...
      <mesh filename="file://$(find my_robot)/meshes/arm.stl"/>
    ```

    ## Use instead

    Give the file the extension `.urdf.xacro`, declare `xmlns:xacro="http://www.ros.org/wiki/xacro"` on `<robot>`, and
    expand the file with xacro.
    """

    code = "LW114"
    name = "xacro-in-urdf"
    severity = Severity.ERROR

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every URI with an expression.

        The URDF reader reports expressions in place of numbers.
        """
        if subject.expansion is not None:
            return
        for schema_element in subject.structure.schema_elements:
            for attribute, value in schema_element.element.attributes.items():
                rule = schema_element.rule.attribute_rules.get(attribute)
                if rule is None or rule.type is not TEXT:
                    continue
                if "${" in value or "$(" in value:
                    yield self.report(
                        phrase("'{expression}' is not evaluated, because this file is plain URDF", expression=value),
                        schema_element.element,
                        attribute,
                        hint=phrase(
                            'declare xmlns:xacro="http://www.ros.org/wiki/xacro" on <robot>, and rename the file '
                            "to {stem}.urdf.xacro",
                            stem=PurePath(subject.path).stem,
                        ),
                    )


class StrayText(Rule):
    """Text in an element that does not contain text.

    ## Why

    In URDF, all values are in attributes. A text, such as in `<mass>3</mass>` or after a forgotten `-->`, is not read.

    ## Example

    ```xml
    <link name="arm"> 3 kg
      <visual> ...
    ```

    ## Use instead

    Turn the text into a comment, `<!-- 3 kg -->`, or remove it.
    """

    code = "LW116"
    name = "stray-text"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every text that contains more than white space.

        A text is left out if the reader reports a missing value at the same element.
        """
        reported_spans = {diagnostic.span for diagnostic in subject.reading.diagnostics}
        for schema_element in subject.structure.schema_elements:
            texts = [
                child for child in schema_element.element.children if isinstance(child, Text) and child.data.strip()
            ]
            if not texts or schema_element.element.span() in reported_spans:
                continue
            for child in texts:
                text = " ".join(child.data.split())
                text = text if len(text) <= 40 else f"{text[:40]}..."
                span = None
                if child.source is not None:
                    start = child.offset + len(child.data) - len(child.data.lstrip())
                    span = child.source.span(start, start + len(child.data.strip().partition("\n")[0]))
                yield self.report(
                    phrase(
                        "the text '{text}' in {element} is not read",
                        text=text,
                        element=schema_element if schema_element.owner else "<robot>",
                    ),
                    schema_element.element,
                    span=span,
                    source=child.source,
                    hint=phrase("make it a comment: <!-- {text} -->", text=text)
                    if "--" not in text
                    else phrase("remove it"),
                )


class EmptyName(Rule):
    """A link, joint or robot with an empty name.

    ## Why

    urdfdom accepts an empty name. However, tf2 refuses frames without a name, and joint states cannot be matched to a
    joint without a name.

    ## Example

    ```xml
    <link name=""/>
    ```

    ## Use instead

    ```xml
    <link name="base_link"/>
    ```
    """

    code = "LW117"
    name = "empty-name"
    holds_for_parts = True
    severity = Severity.ERROR

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Report every name that is empty or consists only of white space."""
        named_elements = [element for element in subject.elements() if element.tag in ("link", "joint")]
        for element in [subject.root, *named_elements]:
            name = element.attributes.get("name")
            if name is not None and not name.strip():
                yield self.report(
                    phrase("the name of a <{tag}> is empty", tag=element.tag),
                    element,
                    "name",
                    hint=phrase("give it a name"),
                    severity=Severity.WARNING if element is subject.root else None,
                )
