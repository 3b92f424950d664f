"""Rules about unused definitions in xacro files.

A name counts as used if any file of the description, or any other description file of the package, mentions it. The
rules do not apply if names may be composed from values, or to files that only contain definitions for other files to
include.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from math import isclose, pi
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Phrase, Severity, phrase
from linkwright.diagnostics.misspellings import find_misspelled
from linkwright.lint.fix import remove_element
from linkwright.lint.rules.xacro_rule import XacroRule
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.xmltree import Element

if TYPE_CHECKING:
    from linkwright.lint.xacro_facts import Definition, FileFacts, XacroFacts

_MESSAGE_CALL = lazy_pattern(r"\b(?:fatal|error|warning|message)\s*\(")
"""Functions that are called for their side effect."""

_CONSTANTS = (pi / 4, pi / 2, pi, 2 * pi, pi / 180, 180 / pi)
_ROUNDING_TOLERANCE = 6e-4
"""The greatest relative difference between a rounded number, such as 3.14 or 1.57, and its constant."""
_COMMENT = lazy_pattern(r"<!--.*?-->", re.DOTALL)
_CALL = lazy_pattern(r"<xacro:([\w.-]+)")


class UnusedProperty(XacroRule):
    """A property that nothing uses.

    ## Why

    A user who changes the value expects the robot to change. Often, the place that should use the property contains a
    literal number.

    Only properties of the checked file and properties inside macros are checked, because a file of properties for
    several robots contains more than each robot needs. Mathematical constants, such as `PI`, are not reported. Neither
    is a property with `lazy_eval="false"` that calls `xacro.fatal`, `error`, `warning` or `message`. If the property
    belongs to a table of dimensions, the finding is only informational, because such tables are usually complete. An
    example is an unused `d415_cam_depth_px` next to `d415_cam_depth_py` and `d415_cam_depth_pz`, which are used.

    ## Example

    ```xml
    <xacro:property name="wheel_radius" value="0.06"/>
    <cylinder radius="0.06" length="0.02"/>
    ```

    ## Use instead

    ```xml
    <xacro:property name="wheel_radius" value="0.06"/>
    <cylinder radius="${wheel_radius}" length="0.02"/>
    ```
    """

    code = "LW701"
    name = "unused-property"
    needs_all_sets = True

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        if facts.is_open or facts.is_library:
            return
        for file in facts.package_files.values():
            for definition in file.properties:
                name, element = definition.name, definition.element
                if "$" in name or not name or name in facts.names or _is_removal(element) or _shows_message(element):
                    continue
                if _is_mathematics(element.attributes.get("value", "")):
                    continue
                if file is not facts.main and (definition.macro is None or "scope" in element.attributes):
                    continue
                yield self.report(
                    phrase("nothing uses the property '{name}'", name=name),
                    element,
                    "name",
                    hint=_make_hint(name, facts.names),
                    fix=remove_element(element, safe=False),
                    severity=Severity.INFO if _belongs_to_table(definition, file, facts.names) else None,
                )


class UnusedArgument(XacroRule):
    """An argument that nothing uses.

    ## Why

    A user who sets the argument, on the command line or in a launch file, sees no change.

    ## Example

    ```xml
    <xacro:arg name="use_lidar" default="true"/>
    <xacro:include filename="lidar.xacro"/>
    ```

    ## Use instead

    ```xml
    <xacro:arg name="use_lidar" default="true"/>
    <xacro:if value="$(arg use_lidar)">
      <xacro:include filename="lidar.xacro"/>
    </xacro:if>
    ```
    """

    code = "LW702"
    name = "unused-argument"
    needs_all_sets = True

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        if facts.has_open_arguments:
            return
        for file in facts.package_files.values():
            for definition in file.arguments:
                name = definition.name
                if name and "$" not in name and name not in facts.used_arguments and _is_first(definition, file):
                    yield self.report(
                        phrase("nothing uses the argument '{name}'", name=name),
                        definition.element,
                        "name",
                        hint=_make_hint(name, facts.used_arguments, "$(arg ...)"),
                        fix=remove_element(definition.element, safe=False),
                    )


class UnusedMacro(XacroRule):
    """A macro that nothing calls.

    ## Why

    The content of the macro is missing from the robot. Either the call was forgotten, or the macro is left over from an
    earlier version.

    The rule only checks macros of the checked file, and only if this file describes a robot, because libraries of
    macros contain more than each robot needs.

    ## Example

    ```xml
    <xacro:macro name="caster" params="side">
      ...
    </xacro:macro>
    ```

    ## Use instead

    ```xml
    <xacro:macro name="caster" params="side">
      ...
    </xacro:macro>
    <xacro:caster side="1"/>
    ```
    """

    code = "LW703"
    name = "unused-macro"
    severity = Severity.INFO
    needs_all_sets = True

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        if facts.is_library or facts.has_open_calls:
            return
        for definition in facts.main.macros:
            if definition.name and definition.name not in facts.called_macros:
                yield self.report(
                    phrase("nothing calls the macro '{name}'", name=definition.name),
                    definition.element,
                    "name",
                    hint=_make_hint(definition.name, facts.called_macros, f"<xacro:{definition.name} .../>"),
                    fix=remove_element(definition.element, safe=False),
                )


class UnusedInclude(XacroRule):
    """An include of a file that contributes nothing.

    ## Why

    The file neither adds anything to the robot nor defines anything that the description uses. Every expansion reads
    the file without need, and readers of the description search for its purpose.

    ## Example

    ```xml
    <xacro:include filename="laser.xacro"/>  <!-- defines the macro laser, which nothing calls -->
    ```

    ## Use instead

    Use the definitions of the file, or remove the include.
    """

    code = "LW704"
    name = "unused-include"
    severity = Severity.INFO
    needs_all_sets = True

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        if facts.is_library or any(
            file.is_open or file.has_open_calls or file.has_bare_tags for file in facts.files.values()
        ):
            return
        paths = _find_included_paths(facts)
        for file in facts.package_files.values():
            for include in file.includes:
                path = paths.get(id(include.element))
                if path is not None and not (_has_effect(path, facts, paths) or _has_commented_call(path, facts)):
                    yield self.report(
                        phrase("nothing in the included file '{name}' is used", name=Path(path).name),
                        include.element,
                        "filename",
                        hint=phrase("use a macro or property of the included file, or remove the include"),
                        fix=remove_element(include.element, safe=False),
                    )


class UnusedMacroParameter(XacroRule):
    """A parameter of a macro that its body does not use.

    ## Why

    Every call must set the parameter, but its value has no effect. If the parameter is intended for a macro that is
    called in the body, it must be passed on. Usually, the parameter is left over from an earlier version, which is
    harmless.

    ## Example

    ```xml
    <xacro:macro name="wheel" params="prefix radius">
      <link name="${prefix}_wheel">
        <visual><geometry><cylinder radius="0.06" length="0.02"/></geometry></visual>
      </link>
    </xacro:macro>
    ```

    ## Use instead

    ```xml
        <visual><geometry><cylinder radius="${radius}" length="0.02"/></geometry></visual>
    ```
    """

    code = "LW705"
    name = "unused-macro-parameter"
    severity = Severity.INFO
    needs_all_sets = True

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        if facts.has_open_calls:
            return  # Macros that are called by a computed name must all accept the same parameters.
        shared_names = _find_shared_parameters(facts)
        for file in facts.package_files.values():
            if file.has_bare_tags:
                continue
            for macro in file.macros:
                if next(macro.element.elements(), None) is None:
                    continue  # an empty macro with the parameters of others that replace it
                yield from (
                    finding for name, finding in self._check_macro(macro, file, facts) if name not in shared_names
                )

    def _check_macro(self, macro: Definition, file: FileFacts, facts: XacroFacts) -> Iterator[tuple[str, Diagnostic]]:
        from linkwright.lint.xacro_facts import parameter_span

        used_names, blocks, is_open = _find_used_names(macro.element, file)
        calls_others = bool(file.calls_by_macro.get(id(macro.element)))
        for parameter in file.parameters(macro.element):
            name = parameter.name.lstrip("*")
            if parameter.forward:
                continue  # a forwarded parameter need not be set in a call
            if parameter.is_block:
                is_used = name in blocks or (calls_others and any(name in file.blocks for file in facts.files.values()))
            else:
                # A called macro sees the parameters of its caller, so a name that is used elsewhere may be this
                # parameter.
                is_used = name in used_names or is_open or (calls_others and (name in facts.names or facts.is_open))
                is_used = is_used or (bool(blocks) and name in facts.names)
            if name and not is_used and name.isidentifier():
                span = parameter_span(macro.element, parameter)
                message = (
                    phrase("the macro '{macro}' does not use its block '{name}'", macro=macro.name, name=name)
                    if parameter.is_block
                    else phrase("the macro '{macro}' does not use its parameter '{name}'", macro=macro.name, name=name)
                )
                hint = phrase("use it, or remove it here and in the calls")
                yield name, self.report(message, macro.element, "params", span=span, hint=hint)


def _find_shared_parameters(facts: XacroFacts) -> set[str]:
    """Return the names of parameters that several macros share by convention.

    A macro need not use such a parameter.
    """
    counts = Counter(
        name
        for file in facts.files.values()
        for macro in file.macros
        for name in {parameter.name.lstrip("*") for parameter in file.parameters(macro.element)}
    )
    return {name for name, count in counts.items() if count > 1}


def _find_used_names(macro: Element, file: FileFacts) -> tuple[set[str], set[str], bool]:
    """Return the names and the blocks that a macro's body mentions.

    The third result is whether the body may also mention other names.
    """
    names: set[str] = set()
    is_open = False
    for use in (*file.uses_by_macro.get(id(macro), ()), *file.parameter_uses.get(id(macro), ())):
        names |= use.mentions.names
        is_open = is_open or use.mentions.is_open or bool(use.mentions.pasted_arguments)
    blocks: set[str] = set()
    for element in macro.walk():
        if element.tag == "xacro:insert_block":
            blocks.add(element.attributes.get("name", ""))
        if element.tag == "xacro:call" or element.tag == "xacro:element":
            is_open = True
        if element.tag == "xacro:macro" and element is not macro:
            names |= {parameter.name for parameter in file.parameters(element) if parameter.forward}
    return names, blocks, is_open


def _shows_message(element: Element) -> bool:
    """Return whether a property is evaluated at its definition and shows a message to the user."""
    is_lazy = element.attributes.get("lazy_eval", "true").strip() not in ("false", "False", "0")
    return (not is_lazy or "scope" in element.attributes) and bool(
        _MESSAGE_CALL.search(element.attributes.get("value", ""))
    )


def _belongs_to_table(definition: Definition, file: FileFacts, used_names: frozenset[str]) -> bool:
    """Return whether a property belongs to a table of mostly used properties.

    The properties of a table are in one file, and their names differ only in the last word.
    """
    table, _, _ = definition.name.rpartition("_")
    if "_" not in table or find_misspelled(definition.name, used_names) is not None:
        return False
    siblings = {definition.name for definition in file.properties if definition.name.rpartition("_")[0] == table} - {
        definition.name
    }
    return len(siblings & used_names) >= max(2, len(siblings - used_names) + 1)


def _is_mathematics(value: str) -> bool:
    """Return whether a value is a multiple of pi, or converts between degrees and radians."""
    if re.fullmatch(r"\$\{[\s\d.*/()-]*\bpi\b[\s\d.*/()-]*\}", value.strip()):
        return True
    try:
        number = abs(float(value))
    except ValueError:
        return False
    return any(isclose(number, constant, rel_tol=_ROUNDING_TOLERANCE) for constant in _CONSTANTS)


def _is_removal(element: Element) -> bool:
    return "remove" in element.attributes


def _is_first(definition: Definition, file: FileFacts) -> bool:
    first = next(argument for argument in file.arguments if argument.name == definition.name)
    return first is definition


def _make_hint(name: str, used_names: frozenset[str], form: str = "${...}") -> Phrase:
    intended = find_misspelled(name, used_names)
    if intended is not None:
        return phrase("rename it to '{close}', which is used, or remove it", close=intended)
    return phrase("use it with {form}, or remove it", form=form)


def _find_included_paths(facts: XacroFacts) -> dict[int, Path]:
    """Return the path of the file that each include reads, by the `id` of its element.

    Includes with a namespace, and includes whose file is not unique, are left out.
    """
    paths: dict[int, Path] = {}
    paths_by_name: dict[str, list[Path]] = {}
    for path in facts.files:
        paths_by_name.setdefault(path.name, []).append(path)
    for file in facts.files.values():
        for include in file.includes:
            name = include.name.replace("\\", "/").rpartition("/")[2]
            matching_paths = paths_by_name.get(name, [])
            if len(matching_paths) == 1 and "ns" not in include.element.attributes:
                paths[id(include.element)] = matching_paths[0]
    return paths


def _has_commented_call(path: Path, facts: XacroFacts) -> bool:
    """Return whether a comment contains a call of a macro that an included file defines.

    The author can enable such a call, so the include is useful.
    """
    macro_names = {macro.name for macro in facts.files[path].macros} if path in facts.files else set()
    texts = (file.document.source.text for file in facts.package_files.values() if file.document.source is not None)
    comments = (comment for text in texts for comment in _COMMENT.findall(text))
    return any(call_name in macro_names for comment in comments for call_name in _CALL.findall(comment))


def _has_effect(path: Path, facts: XacroFacts, paths: dict[int, Path]) -> bool:
    """Return whether a file or its includes add elements to the robot, or define used names.

    An empty file is treated as contributing, because it is probably unfinished.
    """
    nested_files: dict[Path, FileFacts] = {}
    pending = [path]
    while pending:
        current = pending.pop()
        if current in nested_files:
            continue
        file = facts.files.get(current)
        if file is None:
            return True
        nested_files[current] = file
        for include in file.includes:
            nested_path = paths.get(id(include.element))
            if nested_path is None:
                return True
            pending.append(nested_path)
    if not any(file.macros or file.properties or file.arguments for file in nested_files.values()):
        return True
    other_files = [file for other_path, file in facts.files.items() if other_path not in nested_files]
    names = {name for file in other_files for name in file.names | file.blocks}
    called_names = {name for file in other_files for name in file.called_macros}
    arguments = {name for file in facts.files.values() for name in file.used_arguments}
    for file in nested_files.values():
        if file.has_content or file.is_open or any(call.macro is None for call in file.calls):
            return True
        if any(definition.name in names or "$" in definition.name for definition in file.properties):
            return True
        if any(definition.name in called_names for definition in file.macros):
            return True
        if any(definition.name in arguments for definition in file.arguments):
            return True
    return False
