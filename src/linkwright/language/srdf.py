"""Language features for SRDF: groups, and the links and joints of the description."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cached_property
from itertools import islice
from pathlib import Path

from linkwright.language.completion import Completion, ItemKind
from linkwright.language.cursor import Cursor, CursorSyntax, cursor_at
from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.format import Document, Format, Target
from linkwright.language.grammar import rule_at
from linkwright.language.hover import Explanation, definitions_at
from linkwright.language.hover_facts import describe_part, facts_at
from linkwright.language.includes import real_path
from linkwright.language.links import FileReference, file_references
from linkwright.language.outline import Outline
from linkwright.language.robot_names import find_mentioned_robots
from linkwright.language.srdf_schema import CHOICES, GROUP, JOINT, LINK, SRDF
from linkwright.language.values import evaluate_file
from linkwright.language.xml_completion import complete
from linkwright.language.xml_hover import explain_at
from linkwright.packages import enclosing_package
from linkwright.packages.readers.entry_points import read_text
from linkwright.packages.share_layout import find_source
from linkwright.schema import AttributeRule
from linkwright.urdf import Robot
from linkwright.xmltree.tokens import Kind, tokens

_ROBOT_NAME = re.compile(r"<robot\b[^>]*?\bname\s*=\s*[\"']([^\"']+)[\"']")
_SETUP_ASSISTANT_URDF = re.compile(r"URDF:\s*\n\s+package:\s*(\S+)\s*\n\s+relative_path:\s*(\S+)")
_EXPRESSION = re.compile(r"\$\{[^{}]*\}|\$\([^()]*\)")
_MAX_ROBOTS = 3
_MAX_SHOWN_PARTS = 12
_MAX_HEAD_LENGTH = 20_000
"""The number of characters of a description that are searched for the name of the robot."""


def is_srdf(path: Path) -> bool:
    """Return whether a file is an SRDF, by its name."""
    return path.name.endswith((".srdf", ".srdf.xacro"))


class _Semantics:
    """An SRDF, with the descriptions that it belongs to."""

    def __init__(self, document: Document) -> None:
        self.document = document

    @cached_property
    def names(self) -> list[NameDefinition]:
        return self.document.workspace.names(self.document.file, self.document.texts)

    @cached_property
    def descriptions(self) -> list[Path]:
        """The descriptions of the robot, found by MoveIt's Setup Assistant or the robot's name."""
        workspace, file = self.document.workspace, self.document.file
        package = enclosing_package(file.parent)
        descriptions = [*self._setup_assistant_descriptions(package[1])] if package is not None else []
        robot_name = _ROBOT_NAME.search(self.document.text)
        name = robot_name[1] if robot_name is not None else ""
        neighbors = workspace.package_neighbors(file, ())
        for other in dict.fromkeys((*neighbors, *workspace.index.files)):
            head = _ROBOT_NAME.search(self.document.other(other)[:_MAX_HEAD_LENGTH]) if name else None
            if head is not None and head[1] == name and not is_srdf(other):
                descriptions.append(other)
        descriptions_beside = [other for other in neighbors if ".urdf" in other.name and not is_srdf(other)]
        words = {attribute.value or "" for token in tokens(self.document.text) for attribute in token.attributes()}
        return [
            *islice(
                dict.fromkeys(descriptions or find_mentioned_robots(self.document, words) or descriptions_beside),
                _MAX_ROBOTS,
            )
        ]

    def _setup_assistant_descriptions(self, folder: Path) -> Iterator[Path]:
        for match in _SETUP_ASSISTANT_URDF.finditer(read_text(folder / ".setup_assistant")):
            share = self.document.finder.find(match[1])
            if share is not None and (share / match[2]).is_file():
                yield real_path(find_source(str(share / match[2])))

    @cached_property
    def robots(self) -> list[Robot]:
        robots = (self.document.workspace.robot(file, self.document.texts) for file in self.descriptions)
        return [robot for robot in robots if robot is not None]

    def parts(self, kind: NameKind) -> list[str]:
        """Return the names of the links or joints, in the order of the descriptions."""
        names_by_robot = [robot.links if kind is NameKind.LINK else robot.joints for robot in self.robots]
        return [*dict.fromkeys(name for names in names_by_robot for name in names)]

    def groups(self) -> dict[str, int]:
        """Return the names of the groups, each with its offset."""
        groups: dict[str, int] = {}
        for token in tokens(self.document.text):
            if token.kind is Kind.START and token.name == "group":
                for attribute in token.attributes():
                    if attribute.name == "name" and attribute.value:
                        groups.setdefault(attribute.value, attribute.value_start)
        return groups


def _find_rule(cursor: Cursor) -> AttributeRule | None:
    """Return the rule of the attribute whose value is at a cursor, or None."""
    if cursor.syntax is not CursorSyntax.VALUE or cursor.attribute is None:
        return None
    rule = rule_at(SRDF, cursor.tags)
    return None if rule is None else rule.attribute_rules.get(cursor.attribute.name)


def _is_group(cursor: Cursor, rule: AttributeRule) -> bool:
    """Return whether a value refers to a group, as in a group inside a group."""
    return rule.type is GROUP or (rule.name == "name" and cursor.tags[-2:] == ("group", "group"))


def _complete(document: Document, offset: int) -> Iterator[Completion]:
    semantics, cursor = _Semantics(document), cursor_at(document.text, offset)
    rule = _find_rule(cursor)
    if rule is None or "$" in cursor.typed:
        yield from complete(document, offset, semantics.names)
        return
    start = offset - len(cursor.typed)
    for choice in CHOICES.get((cursor.tags[-1], rule.name), ()):
        yield Completion(choice, ItemKind.VALUE, start)
    if rule.type in (LINK, JOINT):
        kind = NameKind.LINK if rule.type is LINK else NameKind.JOINT
        present = _find_sibling_names(document.text, offset) if rule.name == "name" else set()
        for name in semantics.parts(kind):
            if name not in present:
                yield Completion(name, ItemKind.NAME, start, kind.value)
    elif _is_group(cursor, rule):
        for name, group_offset in semantics.groups().items():
            if group_offset != start:
                yield Completion(name, ItemKind.NAME, start)


def _find_sibling_names(text: str, offset: int) -> set[str | None]:
    """Return the names of the siblings with the same tag as the element at an offset."""
    lineage = Outline.of(text).elements_around(offset)
    siblings = lineage[-2].children if len(lineage) > 1 else []
    others = (other for other in siblings if other is not lineage[-1] and other.tag.name == lineage[-1].tag.name)
    return {attribute.value for other in others for attribute in other.tag.attributes() if attribute.name == "name"}


def _explain(document: Document, offset: int) -> Explanation | None:
    semantics, cursor = _Semantics(document), cursor_at(document.text, offset)
    rule = _find_rule(cursor)
    if rule is not None and rule.type in (LINK, JOINT) and cursor.attribute is not None and cursor.attribute.value:
        kind = NameKind.LINK if rule.type is LINK else NameKind.JOINT
        name = cursor.attribute.value
        facts = next(
            (robot_facts for robot in semantics.robots if (robot_facts := describe_part(robot, kind, name))), None
        )
        if facts is not None:
            text = f"**{kind.value} {name}**\n\n{facts}"
            return Explanation(text, cursor.attribute.value_start, cursor.attribute.value_end)
    if rule is not None and cursor.attribute is not None and _is_group(cursor, rule):
        described = _describe_group(document.text, cursor.attribute.value or "")
        if described:
            return Explanation(described, cursor.attribute.value_start, cursor.attribute.value_end)
    explanation = explain_at(document, offset, semantics.names)
    if explanation is not None or not document.file.name.endswith(".xacro"):
        return explanation
    values = evaluate_file(document.workspace, document.texts, document.file)
    further_facts = facts_at(document.workspace, document.texts, document.file, document.text, offset, values)
    return Explanation("\n\n".join(further_facts), offset, offset) if further_facts else None


def _describe_group(text: str, name: str) -> str:
    """Return the content of a group in Markdown, or empty if the text does not define it."""
    for element in (
        candidate for root in Outline.of(text).elements for candidate in root.children if candidate.tag.name == "group"
    ):
        if (
            any((candidate.name, candidate.value) == ("name", name) for candidate in element.tag.attributes())
            and element.children
        ):
            lines = [
                f"- {child.tag.name} " + ", ".join(f"`{candidate.value}`" for candidate in child.tag.attributes())
                for child in element.children[:_MAX_SHOWN_PARTS]
            ]
            ellipsis = ["- ..."] if len(element.children) > _MAX_SHOWN_PARTS else []
            return "\n".join([f"**group {name}**", "", *lines, *ellipsis])
    return ""


def _define(document: Document, offset: int) -> Iterator[Target]:
    semantics, cursor = _Semantics(document), cursor_at(document.text, offset)
    value = cursor.attribute.value if cursor.attribute is not None else None
    rule = _find_rule(cursor)
    if rule is not None and value and rule.type in (LINK, JOINT):
        kind = NameKind.LINK if rule.type is LINK else NameKind.JOINT
        yield from _find_part_targets(semantics, kind, value)
    elif rule is not None and value and _is_group(cursor, rule):
        start = semantics.groups().get(value)
        if start is not None:
            yield Target(document.file, start, start + len(value))
    else:
        for name in definitions_at(document.text, offset, semantics.names):
            yield Target(name.file, name.start, name.start + len(name.name))
        yield from (Target(link.file) for link in _links(document) if link.start <= offset <= link.end)


def _find_part_targets(semantics: _Semantics, kind: NameKind, value: str) -> Iterator[Target]:
    """Yield the definitions of a link or joint, by its name or a name with expressions."""
    document = semantics.document
    for file in semantics.descriptions:
        names = document.workspace.names(file, document.texts)
        names_of_kind = [name for name in names if name.kind is kind and _matches(name.name, value)]
        if kind is NameKind.JOINT:
            names_of_kind = [
                name for name in names_of_kind if name.detail
            ]  # Only the definition of a joint has a type.
        exact = [name for name in names_of_kind if name.name == value]
        for name in dict.fromkeys(exact or names_of_kind):
            yield Target(name.file, name.start, name.start + len(name.name))
        if names_of_kind:
            return


def _matches(source_name: str, value: str) -> bool:
    """Return whether a value matches a written name that is not only an expression."""
    parts = _EXPRESSION.split(source_name)
    if not any(parts):
        return False
    return re.fullmatch(".*".join(map(re.escape, parts)), value) is not None


def _links(document: Document) -> Iterator[FileReference]:
    return file_references(document.text, document.file, document.finder)


SRDF_FILES = Format(is_srdf, _complete, _explain, _define, _links, needs_index=True)
"""The format of SRDF, with or without xacro."""
