"""Rules about xacro tags: prefixes, namespaces, includes, packages and recursion."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from itertools import product
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase
from linkwright.lint.fix import Fix, add_attribute, rename_element, replace_value
from linkwright.lint.rule import Rule
from linkwright.lint.rules.xacro_rule import XacroRule
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.schema import ElementRule
from linkwright.urdf.schema import ROBOT
from linkwright.xmltree import Element

if TYPE_CHECKING:
    from linkwright.lint.xacro_facts import Definition, FileFacts, XacroFacts

NAMESPACE_URI = "http://www.ros.org/wiki/xacro"
_OLD_NAMESPACE_URI = lazy_pattern(r"https?://(www\.)?ros\.org/(wiki/xacro|xacro)/?(#interface)?")
_REQUIRED_ATTRIBUTES: dict[str, tuple[str, ...]] = {
    "property": ("name",),
    "include": ("filename",),
    "macro": ("name",),
    "arg": ("name",),
    "if": ("value",),
    "unless": ("value",),
    "insert_block": ("name",),
}
_CONDITION_TAGS = frozenset({"xacro:if", "xacro:unless"})
_SIMULATOR_ELEMENTS = frozenset({"gazebo", "plugin", "ros2_control", "sensor", "world", "sdf", "transmission"})
_ABSOLUTE_PATH = lazy_pattern(r"(/|~|file:///|[A-Za-z]:[\\/])")


class XacroPrefixMissing(Rule):
    """A xacro tag is written without the prefix ``xacro:``.

    ## Why

    Without the prefix, the tag is an ordinary element, which xacro copies unchanged and URDF readers ignore. Up to ROS
    Melodic, xacro accepted such tags, so old descriptions may contain them.

    ## Example

    ```xml
    <property name="wheel_radius" value="0.06"/>
    ```

    ## Use instead

    ```xml
    <xacro:property name="wheel_radius" value="0.06"/>
    ```
    """

    code = "LW720"
    name = "xacro-prefix-missing"
    holds_for_parts = True
    of_sources = True
    severity = Severity.ERROR
    replaces = ("LW104", "LW105", "LW107")

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        documents = subject.sources.values()
        elements_by_root = [
            (document.root, list(_iterate_description_elements(document.root))) for document in documents
        ]
        macros = _collect_macro_names(elements for _, elements in elements_by_root)
        for root, elements in elements_by_root:
            if root.tag != "robot":
                continue
            for element in elements:
                required = _REQUIRED_ATTRIBUTES.get(element.tag)
                if required is None and element.tag in macros:
                    required = ()
                if required is None or not all(name in element.attributes for name in required):
                    continue
                message = phrase("<{tag}> lacks the prefix 'xacro:', so xacro does not process it", tag=element.tag)
                hint = phrase("write <xacro:{tag} ...>", tag=element.tag)
                fix = rename_element(element, f"xacro:{element.tag}", safe=False)
                if "xmlns:xacro" not in root.attributes:
                    hint = phrase(
                        'write <xacro:{tag} ...>, and declare the prefix on the root: xmlns:xacro="{address}"',
                        tag=element.tag,
                        address=NAMESPACE_URI,
                    )
                    declaration = add_attribute(root, "xmlns:xacro", NAMESPACE_URI)
                    if fix is not None and declaration is not None:
                        fix = Fix((*declaration.edits, *fix.edits), safe=False)
                yield self.report(message, element, hint=hint, fix=fix)


def _collect_macro_names(documents: Iterable[Iterable[Element]]) -> set[str]:
    """Return the names of all macros that some documents define, except names of URDF elements."""
    macros = (
        element.attributes.get("name", "")
        for elements in documents
        for element in elements
        if element.tag == "xacro:macro"
    )
    return set(macros) - _collect_tags(ROBOT)


def _collect_tags(rule: ElementRule) -> set[str]:
    return {rule.tag}.union(*map(_collect_tags, rule.children))


class XacroNamespaceMissing(XacroRule):
    """A xacro file does not declare the xacro namespace.

    ## Why

    Without `xmlns:xacro` on its root, a tool that ignores the file extension treats the file as plain URDF: it does not
    expand the file, and reads expressions as names and numbers. Pedantic: ROS's xacro still expands the file.

    ## Example

    ```xml
    <robot name="r">
      <link name="${'base'}_link"/>
    ```

    ## Use instead

    ```xml
    <robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
    ```
    """

    code = "LW721"
    name = "xacro-namespace-missing"
    holds_for_parts = True
    default = False

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        file = facts.main
        root = file.document.root
        if "xmlns:xacro" in root.attributes or not file.uses:
            return
        if any(_REQUIRED_ATTRIBUTES.get(element.tag) for element in _iterate_description_elements(root)):
            return  # the prefix is missing, too, which another rule reports
        message = phrase("this file has xacro expressions but does not declare the prefix 'xacro'")
        fix = add_attribute(root, "xmlns:xacro", NAMESPACE_URI)
        yield self.report(
            message,
            root,
            hint=phrase('write <{tag} ... xmlns:xacro="{address}">', tag=root.tag, address=NAMESPACE_URI),
            fix=fix,
        )


class XacroNamespaceAddress(Rule):
    """The prefix ``xacro`` is declared with a URI other than the ROS one.

    ## Why

    Editors that check the file use the URI. Pedantic: xacro only uses the prefix and accepts any URI.

    ## Example

    ```xml
    <robot name="r" xmlns:xacro="http://ros.org/wiki/xacro">
    ```

    ## Use instead

    ```xml
    <robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
    ```
    """

    code = "LW722"
    name = "xacro-namespace-address"
    holds_for_parts = True
    of_sources = True
    default = False

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        for document in subject.sources.values():
            root = document.root
            uri = root.attributes.get("xmlns:xacro", NAMESPACE_URI)
            if uri == NAMESPACE_URI:
                continue
            if _OLD_NAMESPACE_URI.fullmatch(uri):
                message = phrase("the prefix 'xacro' is declared with an old URI")
            else:
                message = phrase("the prefix 'xacro' is not declared with the URI of ROS")
            fix = replace_value(root, "xmlns:xacro", NAMESPACE_URI)
            hint = phrase('write xmlns:xacro="{address}"', address=NAMESPACE_URI)
            yield self.report(message, root, "xmlns:xacro", hint=hint, fix=fix)


class IncludeAbsolutePath(XacroRule):
    """An include uses an absolute path.

    ## Why

    The path exists on one machine only. On any other machine, or in a container, the expansion fails.

    ## Example

    ```xml
    <xacro:include filename="/home/me/ws/src/my_robot/urdf/wheel.xacro"/>
    ```

    ## Use instead

    ```xml
    <xacro:include filename="$(find my_robot)/urdf/wheel.xacro"/>
    ```

    or, for a file in the same folder, `filename="wheel.xacro"`.
    """

    code = "LW723"
    name = "include-absolute-path"
    holds_for_parts = True

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        for file in facts.package_files.values():
            for include in file.includes:
                if _ABSOLUTE_PATH.match(include.name):
                    message = phrase("the file '{name}' is included by an absolute path", name=include.name)
                    hint = phrase("write a path relative to this file, or $(find PACKAGE)/...")
                    yield self.report(message, include.element, "filename", hint=hint)


class IncludeOutsidePackage(XacroRule):
    """An include uses a path that leaves the package.

    ## Why

    The path works in the sources, where the packages are side by side. When installed, each package has its own folder,
    and the path does not exist.

    ## Example

    ```xml
    <xacro:include filename="../../other_package/urdf/wheel.xacro"/>
    ```

    ## Use instead

    ```xml
    <xacro:include filename="$(find other_package)/urdf/wheel.xacro"/>
    ```
    """

    code = "LW728"
    name = "include-outside-package"
    holds_for_parts = True

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        package = facts.package
        if package is None:
            return
        for path, file in facts.package_files.items():
            folder = path.absolute().parent
            if not folder.is_relative_to(package.folder):
                continue
            for include in file.includes:
                if include.name.startswith("../") and "$" not in include.name:
                    target = Path(os.path.normpath(folder / include.name))
                    if not target.is_relative_to(package.folder):
                        message = phrase(
                            "the included file '{name}' is outside the package '{package_name}'",
                            name=include.name,
                            package_name=package.name,
                        )
                        hint = phrase("write $(find PACKAGE)/...")
                        yield self.report(message, include.element, "filename", hint=hint)


class UndeclaredPackage(Rule):
    """``$(find ...)`` names a package that ``package.xml`` does not depend on.

    ## Why

    rosdep and colcon only read dependencies from `package.xml`. On a fresh machine, the package is not installed, and
    the expansion fails. If every use is inside a condition, the package may be optional, and the finding is only
    informational. A package that itself depends on this package is not reported: declaring it would form a cycle.

    ## Example

    ```xml
    <xacro:include filename="$(find realsense2_description)/urdf/_d435.urdf.xacro"/>
    ```

    ## Use instead

    Add to `package.xml`:

    ```xml
    <exec_depend>realsense2_description</exec_depend>
    ```
    """

    code = "LW724"
    name = "undeclared-package"
    holds_for_libraries = True
    of_sources = True

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        if subject.expansion is None:
            return
        from linkwright.lint.dependencies import would_form_cycle
        from linkwright.lint.package_fixes import make_dependency_fix
        from linkwright.xacro.faults import attribute_span

        facts = subject.xacro
        package = facts.package
        if package is None or package.manifest is None:
            return
        reported_packages: set[str] = set()
        for is_optional, file in product((False, True), facts.package_files.values()):
            for use in file.uses:
                if _CONDITION_TAGS.isdisjoint(parent.tag for parent in use.parents) is is_optional:
                    continue
                for name, offset in use.mentions.packages:
                    if name in reported_packages or package.manifest.declares(name) or use.attribute is None:
                        continue
                    reported_packages.add(name)
                    if would_form_cycle(package.manifest, name, subject.finder):
                        continue
                    span = attribute_span(use.element, use.attribute, offset, offset + len(name))
                    message = phrase(
                        "the package '{name}' is used here, but the package.xml of '{package_name}' does not name it",
                        name=name,
                        package_name=package.name,
                    )
                    hint = phrase("add <exec_depend>{name}</exec_depend> to package.xml", name=name)
                    severity = Severity.INFO if is_optional else None
                    fix = make_dependency_fix(package.manifest, [name])
                    yield self.report(
                        message, use.element, use.attribute, span=span, hint=hint, fix=fix, severity=severity
                    )


class RecursiveMacro(XacroRule):
    """A macro calls itself without a condition.

    ## Why

    Such a macro never ends, and xacro fails when the calls are nested too deeply.

    ## Example

    ```xml
    <xacro:macro name="chain" params="count">
      <link name="link_${count}"/>
      <xacro:chain count="${count - 1}"/>
    </xacro:macro>
    ```

    ## Use instead

    ```xml
    <xacro:macro name="chain" params="count">
      <link name="link_${count}"/>
      <xacro:if value="${count > 0}">
        <xacro:chain count="${count - 1}"/>
      </xacro:if>
    </xacro:macro>
    ```
    """

    code = "LW725"
    name = "recursive-macro"
    holds_for_parts = True
    severity = Severity.ERROR

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        for file in facts.package_files.values():
            for macro in file.macros:
                call = _find_unconditional_call(macro, file)
                if call is not None:
                    note = Note(phrase("the macro '{name}' is defined here", name=macro.name), macro.element.span())
                    message = phrase(
                        "the macro '{name}' calls itself without a condition, so a call never ends", name=macro.name
                    )
                    hint = phrase("put the call into xacro:if or xacro:unless")
                    yield self.report(message, call.element, notes=[note], hint=hint)


class IncludeOfItself(XacroRule):
    """A file includes itself, directly or through other files.

    ## Why

    xacro does not detect such an include. Without a condition that ends the recursion, the expansion continues until
    the includes are nested too deeply.

    ## Example

    ```xml
    <!-- wheel.xacro -->
    <xacro:include filename="wheel.xacro"/>
    ```

    ## Use instead

    Move the shared definitions into a third file, which includes neither of the others.
    """

    code = "LW726"
    name = "include-of-itself"
    holds_for_parts = True

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        for path, file in facts.package_files.items():
            for include in file.includes:
                target = include.name.replace("\\", "/")
                if "$" not in target and (path.parent / target).absolute() == path.absolute():
                    message = phrase("'{name}' includes itself", name=path.name)
                    yield self.report(message, include.element, "filename", hint=phrase("remove the include"))


class MacroDefinedTwice(XacroRule):
    """A macro is defined again in the same file with a different body.

    ## Why

    The second definition silently replaces the first. Calls before and after the second definition produce different
    elements.

    ## Example

    ```xml
    <xacro:macro name="wheel" params="prefix">...</xacro:macro>
    <xacro:macro name="wheel" params="prefix radius">...</xacro:macro>
    ```

    ## Use instead

    Give the macros different names, or remove the unintended definition.
    """

    code = "LW727"
    name = "macro-defined-twice"
    holds_for_parts = True

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        for file in facts.package_files.values():
            first_macros: dict[tuple[str, int], Definition] = {}
            for macro in file.macros:
                if macro.is_conditional or not macro.name:
                    continue
                first_macro = first_macros.setdefault((macro.name, id(macro.parents[-1])), macro)
                if first_macro is not macro:
                    note = Note(phrase("first defined here"), first_macro.element.attribute_span("name"))
                    message = phrase("the macro '{name}' is defined twice in this file", name=macro.name)
                    yield self.report(
                        message, macro.element, "name", notes=[note], hint=phrase("rename or remove one of them")
                    )


def _find_unconditional_call(macro: Definition, file: FileFacts) -> Definition | None:
    for call in file.calls_by_macro.get(id(macro.element), ()):
        if call.name != macro.name or call.element.tag != f"xacro:{macro.name}":
            continue
        inner_parents = call.parents[call.parents.index(macro.element) + 1 :]
        if not any(parent.tag.startswith("xacro:") for parent in inner_parents):
            return call
    return None


def _iterate_description_elements(root: Element) -> Iterator[Element]:
    """Yield the elements of a description, except the content for simulators and plugins."""
    pending = [root]
    while pending:
        element = pending.pop()
        if element is not root:
            yield element
        pending.extend(child for child in reversed(list(element.elements())) if child.tag not in _SIMULATOR_ELEMENTS)
