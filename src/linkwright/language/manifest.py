"""Language features for ``package.xml``: dependencies, build types and licenses."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from linkwright.language.completion import Completion, ItemKind
from linkwright.language.cursor import Cursor, CursorSyntax, cursor_at
from linkwright.language.format import Document, Format, Symbol, SymbolKind, Target
from linkwright.language.grammar import rule_at
from linkwright.language.hover import Explanation
from linkwright.language.links import FileReference
from linkwright.language.manifest_schema import PACKAGE, PACKAGE_NAME_TAGS
from linkwright.language.offers import explain_package, offer_packages, offer_values, target_of_package
from linkwright.language.outline import Outline
from linkwright.language.programs import find_used_packages
from linkwright.language.xml_completion import complete
from linkwright.language.xml_hover import explain_at
from linkwright.packages.creation.licenses import list_known_licenses
from linkwright.packages.manifest import MANIFEST

_COMMON_LICENSES = ("Apache-2.0", "BSD-3-Clause", "MIT")
_COMMON_TEXTS = {
    "build_type": ("ament_cmake", "ament_python", "cmake"),
    "member_of_group": ("rosidl_interface_packages",),
    "group_depend": ("rosidl_interface_packages",),
    "version": ("0.1.0",),
}
_COMMON_ATTRIBUTE_VALUES = {"format": ("3", "2"), "type": ("website", "bugtracker", "repository")}
_COMMON_DEPENDENCIES = {
    "buildtool_depend": ("ament_cmake", "ament_cmake_python", "ament_cmake_auto", "rosidl_default_generators"),
    "test_depend": (
        *("ament_lint_auto", "ament_lint_common", "ament_copyright", "ament_flake8", "ament_pep257"),
        *("python3-pytest", "ament_cmake_gtest", "ament_cmake_pytest", "launch_testing", "launch_testing_ament_cmake"),
    ),
    "depend": ("rclcpp", "rclpy", "std_msgs", "geometry_msgs", "sensor_msgs"),
    "build_depend": ("rclcpp", "rosidl_default_generators"),
    "exec_depend": (
        *("rclpy", "launch", "launch_ros", "robot_state_publisher", "joint_state_publisher_gui", "xacro", "rviz2"),
        *("ros2launch", "rosidl_default_runtime", "ros_gz_sim", "ros_gz_bridge", "controller_manager"),
    ),
}
"""The usual dependencies of each tag, which are offered even if the packages are not found."""
_DECLARED_DEPENDENCY = re.compile(r"<(\w+)\b[^<>]*>\s*([\w.-]+)\s*</\1\s*>")


def is_manifest(path: Path) -> bool:
    """Return whether a file describes a package, by its name."""
    return path.name == MANIFEST


def _complete(document: Document, offset: int) -> Iterator[Completion]:
    cursor = cursor_at(document.text, offset)
    typed = cursor.typed.lstrip()
    if cursor.syntax is CursorSyntax.TEXT and cursor.tags and "\n" not in typed:
        completions = [*_offer_texts(document, cursor.tags[-1], offset - len(typed))]
        if completions:
            yield from completions
            return
    if cursor.syntax is CursorSyntax.VALUE and cursor.attribute is not None:
        yield from offer_values(_COMMON_ATTRIBUTE_VALUES.get(cursor.attribute.name, ()), offset - len(cursor.typed))
        return
    present = _list_single_children(document.text, offset)
    for item in complete(document, offset):
        if item.kind is not ItemKind.ELEMENT or item.label not in present:
            yield item


def _list_single_children(text: str, offset: int) -> set[str]:
    """Return the tags of existing siblings at an offset that may occur only once."""
    ancestors = []
    for element in Outline.of(text).elements_around(offset):
        end = element.end if element.closing is None else element.closing.start
        if element.tag.end <= offset <= end and not element.tag.is_empty_element:
            ancestors.append(element)
    rule = rule_at(PACKAGE, [element.tag.name for element in ancestors])
    if rule is None or not ancestors:
        return set()
    names = {child.tag.name for child in ancestors[-1].children if not child.tag.start < offset <= child.tag.end}
    return {name for name in names if name in rule.child_rules and not rule.child_rules[name].is_repeated}


def _offer_texts(document: Document, tag: str, start: int) -> Iterator[Completion]:
    if tag in PACKAGE_NAME_TAGS:
        yield from _offer_dependencies(document, tag, start)
    elif tag == "license":
        yield from offer_values(dict.fromkeys((*_COMMON_LICENSES, *list_known_licenses())), start)
    elif tag == "name":
        yield Completion(document.file.parent.name, ItemKind.PACKAGE, start)
    else:
        yield from offer_values(_COMMON_TEXTS.get(tag, ()), start)


def _offer_dependencies(document: Document, tag: str, start: int) -> Iterator[Completion]:
    """Yield completions of packages: used ones, then common ones of the tag, then the others.

    Packages that the manifest declares are left out.
    """
    others = document.text[:start] + document.text[start:].partition("<")[2]
    declared_names = {name for other, name in _DECLARED_DEPENDENCY.findall(others) if other in (tag, "depend", "name")}
    used_names = find_used_packages(document.file.parent) if tag in ("depend", "exec_depend") else []
    common_names: Iterable[str] = (*used_names, *_COMMON_DEPENDENCIES.get(tag, ()))
    for name in common_names:
        if name not in declared_names:
            declared_names.add(name)
            yield Completion(name, ItemKind.PACKAGE, start)
    for item in offer_packages(document, start):
        if item.label not in declared_names:
            yield item


def _find_dependency_at(document: Document, offset: int) -> tuple[str, int] | None:
    """Return the package name in the element at an offset and its start, or None."""
    cursor: Cursor = cursor_at(document.text, offset)
    if cursor.syntax is not CursorSyntax.TEXT or not cursor.tags or cursor.tags[-1] not in {*PACKAGE_NAME_TAGS, "name"}:
        return None
    begin = offset - len(cursor.typed)
    text = document.text[begin:].partition("<")[0]
    name = text.strip()
    return (name, begin + text.index(name)) if name and "\n" not in name else None


def _explain(document: Document, offset: int) -> Explanation | None:
    dependency = _find_dependency_at(document, offset)
    if dependency is None:
        return explain_at(document, offset)
    text = explain_package(document, dependency[0])
    return Explanation(text, dependency[1], dependency[1] + len(dependency[0])) if text else None


def _define(document: Document, offset: int) -> Iterator[Target]:
    dependency = _find_dependency_at(document, offset)
    if dependency is not None:
        yield from target_of_package(document, dependency[0])


def _links(document: Document) -> Iterator[FileReference]:
    for element in Outline.of(document.text).all():
        for attribute in element.tag.attributes() if element.tag.name == "license" else ():
            file = document.file.parent / (attribute.value or "-")
            if attribute.name == "file" and "\0" not in str(file) and file.is_file():
                yield FileReference(attribute.value_start, attribute.value_end, file)


def _symbols(document: Document) -> Iterator[Symbol]:
    for package in Outline.of(document.text).elements:
        children = []
        for element in package.children:
            inner = document.text[element.tag.end : element.closing.start] if element.closing is not None else ""
            text = " ".join(inner.split()) if "<" not in inner else ""
            kind = SymbolKind.PACKAGE if element.tag.name in PACKAGE_NAME_TAGS else SymbolKind.FIELD
            children.append(Symbol(element.tag.name, kind, element.tag.start, element.end, (), text[:60]))
        name = next((child.detail for child in children if child.name == "name" and child.detail), package.tag.name)
        yield Symbol(name, SymbolKind.GROUP, package.tag.start, package.end, tuple(children))


PACKAGE_XML = Format(is_manifest, _complete, _explain, _define, _links, _symbols)
"""The format of ``package.xml``."""
