"""Rules about xacro expressions, such as deprecated functions and undeclared arguments."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from linkwright.diagnostics import Diagnostic, phrase
from linkwright.lint.fix import Edit, Fix
from linkwright.lint.rules.xacro_rule import XacroRule
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.xmltree import Element
from linkwright.xmltree.positions import attribute_value_range, find_raw_offset

if TYPE_CHECKING:
    from linkwright.lint.xacro_facts import FileFacts, XacroFacts


class DeprecatedFunction(XacroRule):
    """A xacro function is called by its bare name, which is deprecated.

    ## Why

    `load_yaml`, `abs_filename`, `dotify`, `sorted` and `range` have moved into the groups `xacro` and `python`. With
    the bare names, every expansion prints a warning, and a future xacro may not know them. A file that uses both names
    of a function supports older releases of xacro, and is not reported.

    ## Example

    ```xml
    <xacro:property name="config" value="${load_yaml('wheels.yaml')}"/>
    ```

    ## Use instead

    ```xml
    <xacro:property name="config" value="${xacro.load_yaml('wheels.yaml')}"/>
    ```
    """

    code = "LW714"
    name = "deprecated-function"
    holds_for_parts = True
    replaces = ("XAC507",)

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        from linkwright.lint.xacro_names import DEPRECATED

        property_names = {definition.name for file in facts.files.values() for definition in file.properties}
        for file in facts.files.values():
            for use in file.uses:
                if use.attribute is None or use.attribute == "params":
                    continue
                for call in use.mentions.bare_calls:
                    if call.name not in property_names and not _is_called_by(DEPRECATED[call.name], file):
                        yield self._finding(use.element, use.attribute, call.name, call.offset)

    def _finding(self, element: Element, attribute: str, name: str, offset: int) -> Diagnostic:
        from linkwright.lint.xacro_names import DEPRECATED
        from linkwright.xacro.faults import attribute_span

        full_name = DEPRECATED[name]
        span = attribute_span(element, attribute, offset, offset + len(name))
        source = element.source
        fix = None
        if source is not None:
            value_range = attribute_value_range(source.text, element.offset, attribute)
            if value_range is not None:
                start = find_raw_offset(source.text, *value_range, offset)
                if source.text.startswith(name, start):
                    fix = Fix((Edit(source.name, start, start, full_name.removesuffix(name)),))
        message = phrase("calling '{name}' by its bare name is deprecated", name=name)
        return self.report(message, element, attribute, span=span, hint=phrase("write {form}", form=full_name), fix=fix)


def _is_called_by(name: str, file: FileFacts) -> bool:
    """Return whether a file calls a function by its full name, with the group."""
    return file.document.source is not None and f"{name}(" in file.document.source.text


class ConstantCondition(XacroRule):
    """The condition of ``xacro:if`` or ``xacro:unless`` is always the same.

    ## Why

    The content is either always or never included. A constant condition is usually left over from an experiment, and
    hides the structure of the robot.

    ## Example

    ```xml
    <xacro:if value="false">
      <xacro:include filename="lidar.xacro"/>
    </xacro:if>
    ```

    ## Use instead

    ```xml
    <xacro:arg name="use_lidar" default="false"/>
    <xacro:if value="$(arg use_lidar)">
      <xacro:include filename="lidar.xacro"/>
    </xacro:if>
    ```
    """

    code = "LW715"
    name = "constant-condition"

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        from linkwright.lint.xacro_names import is_constant

        for file in facts.package_files.values():
            for element in islice(file.document.root.walk(), 1, None):
                if element.tag not in ("xacro:if", "xacro:unless"):
                    continue
                value = element.attributes.get("value", "")
                if value and is_constant(value):
                    message = phrase("the condition of '{tag}' is always '{value}'", tag=element.tag, value=value)
                    hint = phrase(
                        "make the condition depend on an argument, or remove the tag, and also its content if "
                        "it is never used"
                    )
                    yield self.report(message, element, "value", hint=hint)


class UndeclaredArgument(XacroRule):
    """An undeclared argument is used in a branch that was not taken.

    ## Why

    The expansion fails when the branch is taken and the caller has not set the argument. Pedantic: callers may be
    expected to always set the argument.

    ## Example

    ```xml
    <xacro:arg name="gripper" default="false"/>
    <xacro:if value="$(arg gripper)">
      <xacro:gripper type="$(arg gripper_type)"/>
    </xacro:if>
    ```

    ## Use instead

    ```xml
    <xacro:arg name="gripper" default="false"/>
    <xacro:arg name="gripper_type" default="parallel"/>
    ```
    """

    code = "LW716"
    name = "undeclared-argument"
    default = False

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        if facts.is_library:
            return
        declared_names = set(facts.arguments)
        declared_names |= {definition.name for file in facts.files.values() for definition in file.arguments}
        if any("$" in name for name in declared_names):
            return
        for file in facts.package_files.values():
            for use in file.uses:
                text = use.element.attributes.get(use.attribute, "") if use.attribute else ""
                for name in sorted(use.mentions.arguments - declared_names):
                    if f"$(arg {name})" in text:
                        message = phrase(
                            "the argument '{name}' is not declared, but is used in a branch that is not taken",
                            name=name,
                        )
                        hint = phrase('declare it: <xacro:arg name="{name}" default="..."/>', name=name)
                        yield self.report(message, use.element, use.attribute, hint=hint)
