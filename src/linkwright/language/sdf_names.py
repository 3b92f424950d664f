"""The names of links, joints, frames and models in SDF, with their scopes.

The scope of a name is the model or world around its element. A value such as ``arm::hand::palm`` refers from its own
scope through nested models. Each part of it is a use of the name of one element.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import SourceText, phrase
from linkwright.language.includes import real_path
from linkwright.language.mentions import Mention, mentions_in
from linkwright.language.occurrences import kinds_of_text
from linkwright.language.proof import Edit, ExpansionProof, UnprovedError, apply_edits
from linkwright.language.source_elements import SourceElement, find_innermost_element, source_elements
from linkwright.language.workspace import Workspace

_DEFINING_TAGS = frozenset({"link", "joint", "frame", "model"})
_SCOPE_TAGS = frozenset({"model", "world", "sdf"})
_REFERENCE_ATTRIBUTES = frozenset(
    {"relative_to", "attached_to", "expressed_in", "rotate_to", "canonical_link", "placement_frame"}
)
_INNER_REFERENCES = frozenset({"canonical_link", "placement_frame"})
_MIMIC_REFERENCE = ("mimic", "joint")
_REFERENCE_TAGS = frozenset({"parent", "child", "link", "joint", "gripper_link", "palm_link", "placement_frame"})
_NAME = re.compile(r"[^\s<>&\"':/]+(?: [^\s<>&\"':/]+)*")
_SEPARATOR = "::"
_SUFFIXES = (".sdf", ".world", ".sdf.xacro", ".world.xacro")


@dataclass(frozen=True, slots=True)
class SdfName:
    """A name in an SDF text.

    Attributes:
        name: the name as written.
        file: the file that contains it.
        start: the offset of this occurrence.
        definition: the offset of the start tag of the element that has the name.
    """

    name: str
    file: Path
    start: int
    definition: int

    @property
    def end(self) -> int:
        """The offset after the name."""
        return self.start + len(self.name)


def sdf_names(text: str, file: Path) -> Iterator[SdfName]:
    """Yield the names of links, joints, frames and models in a text, and their uses."""
    for element in source_elements(text):
        if element.name in _DEFINING_TAGS and element.parent is not None:
            for attribute in element.tag.attributes():
                if attribute.name == "name" and attribute.value and _defines(element):
                    yield SdfName(attribute.value, file, attribute.value_start, element.start)
        for value, start, scope in _find_references(element, text):
            for part, offset, owner in _find_referred_elements(scope, value):
                yield SdfName(part, file, start + offset, owner.start)


def find_sdf_name_at(text: str, file: Path, offset: int) -> SdfName | None:
    """Return the name at an offset of an SDF text, or None."""
    return next((name for name in sdf_names(text, file) if name.start <= offset <= name.end), None)


def rename_in_sdf(
    workspace: Workspace, texts: Mapping[Path, str], name: SdfName, new: str
) -> tuple[set[Edit], list[Mention]]:
    """Return the edits that rename a link, joint, frame or model, and uncertain mentions.

    A mention in another file, such as a launch file that starts a model, may have another meaning.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        name: the name, as `find_sdf_name_at` returns it.
        new: the new name.

    Raises:
        UnprovedError: the new name is not valid or exists, the file is outside the workspace, or values would lead
            to other elements.
    """
    text = workspace.text(name.file, texts) or ""
    span = SourceText(str(name.file), text).span(name.start, name.end)
    if not _NAME.fullmatch(new) or _SEPARATOR in new or (new.startswith("__") and new.endswith("__")):
        raise UnprovedError(phrase("'{new}' is not a valid name", new=new), span)
    if not workspace.contains(name.file):
        raise UnprovedError(phrase("'{file}' is outside the workspace", file=name.file.name), span)
    definition = find_innermost_element(source_elements(text), name.definition)
    scope = None if definition is None else _find_scope(definition.parent)
    if definition is None or scope is None:
        raise UnprovedError(phrase("the name is not defined in this file"), span)
    if any(other.value("name") == new for other in _named_children(scope)):
        raise UnprovedError(phrase("'{name}' already exists", name=new), span)
    edits = {
        Edit(use.file, use.start, use.end, new)
        for use in sdf_names(text, name.file)
        if use.definition == name.definition
    }
    _check(workspace, texts, name.file, edits)
    path = _path_from_top(definition)
    unchanged: list[Mention] = []
    configurations = workspace.configuration_files(name.file)
    for file in dict.fromkeys((*workspace.files(_SUFFIXES), *configurations)):
        if file == name.file:
            continue
        other = workspace.text(file, texts) or ""
        file_edits: set[Edit] = set()
        if path is not None and file.name.endswith(_SUFFIXES):
            file_edits = {*_edit_includer(other, file, name.file, path, new)}
        edits |= file_edits
        if file in configurations or file_edits:
            edited_starts = {edit.start for edit in file_edits}
            mentions = mentions_in(other, file, frozenset({name.name}))
            unchanged += [mention for mention in mentions if mention.start not in edited_starts]
    return edits, unchanged


def _check(workspace: Workspace, texts: Mapping[Path, str], file: Path, edits: set[Edit]) -> None:
    """Check that the edits keep the number of references to elements in the file.

    For a xacro file, check its expansions, too.
    """
    text = workspace.text(file, texts) or ""
    pairs = [(text, apply_edits(text, edits))]
    if file.name.endswith(".xacro"):
        proof = ExpansionProof(workspace, texts, file, is_partial=True)
        pairs += [(pair.text_before, pair.text_after) for pair in proof.pairs(edits)]
    for before, after in pairs:
        if len([*sdf_names(before, file)]) != len([*sdf_names(after, file)]):
            raise UnprovedError(phrase("some references keep the old name"))


def _defines(element: SourceElement) -> bool:
    """Return whether an element belongs to a model or world, and not to a plugin or state."""
    parent = element.parent
    if any(outer.name == "state" for outer in element.ancestors_and_self()):
        return False
    return parent is not None and parent.name in _SCOPE_TAGS


def _find_scope(element: SourceElement | None) -> SourceElement | None:
    """Return the innermost model or world that is or contains an element, or None."""
    while element is not None and element.name not in _SCOPE_TAGS:
        element = element.parent
    return element


def _named_children(scope: SourceElement) -> Iterator[SourceElement]:
    return (child for child in scope.children if child.name in _DEFINING_TAGS)


def _find_references(element: SourceElement, text: str) -> Iterator[tuple[str, int, SourceElement]]:
    """Yield the values of an element that may contain names, with offset and scope."""
    for attribute in element.tag.attributes():
        is_reference = attribute.name in _REFERENCE_ATTRIBUTES or (element.name, attribute.name) == _MIMIC_REFERENCE
        if is_reference and attribute.value:
            own = element if attribute.name in _INNER_REFERENCES and element.name == "model" else None
            scope = own or _find_attribute_scope(element)
            if scope is not None:
                yield attribute.value, attribute.value_start, scope
    if element.name in ("model", "link"):
        yield from _find_state_reference(element)
    is_named = element.name in _REFERENCE_TAGS or bool(kinds_of_text(element.name))
    if is_named and not element.children and not _defines(element) and element.end > 0:
        begin = element.tag.end
        written = text[begin : text.find("<", begin)]
        value = written.strip()
        scope = _find_scope(element.parent)
        if value and scope is not None:
            yield value, begin + written.index(value), scope


def _find_state_reference(element: SourceElement) -> Iterator[tuple[str, int, SourceElement]]:
    """Yield the name of a model or link in the state of a world, as a use of that name."""
    lineage = [*element.ancestors_and_self()]
    state = next((index for index, outer in enumerate(lineage) if outer.name == "state"), None)
    scope = None if state is None else _find_scope(lineage[state].parent)
    name = next(
        (candidate for candidate in element.tag.attributes() if candidate.name == "name" and candidate.value), None
    )
    if state is None or scope is None or name is None:
        return
    for outer in reversed(lineage[1:state]):
        child = next(
            (candidate for candidate in _named_children(scope) if candidate.value("name") == outer.value("name")), None
        )
        if child is None:
            return
        scope = child
    yield name.value or "", name.value_start, scope


def _find_attribute_scope(element: SourceElement) -> SourceElement | None:
    """Return the scope of an element's attributes, or None if there is none.

    The scope of a model's pose is outside the model.
    """
    parent = element.parent
    if element.name == "pose" and parent is not None and parent.name == "model":
        return _find_scope(parent.parent)
    return _find_scope(parent)


def _find_referred_elements(scope: SourceElement, value: str) -> Iterator[tuple[str, int, SourceElement]]:
    """Yield the parts of a value that refer to elements, with the offset and the element."""
    offset = 0
    current: SourceElement | None = scope
    for part in value.split(_SEPARATOR):
        element = (
            None
            if current is None
            else next((candidate for candidate in _named_children(current) if candidate.value("name") == part), None)
        )
        if element is None:
            return
        yield part, offset, element
        offset += len(part) + len(_SEPARATOR)
        current = element if element.name == "model" else None


def _path_from_top(element: SourceElement) -> tuple[str, ...] | None:
    """Return the names from the outermost model to an element, or None inside a world."""
    names: list[str] = []
    current: SourceElement | None = element
    while current is not None and current.name != "sdf":
        if current.name == "world":
            return None
        names.append(current.value("name"))
        current = current.parent
    return tuple(reversed(names))


def _edit_includer(text: str, file: Path, model: Path, path: tuple[str, ...], new: str) -> Iterator[Edit]:
    """Yield the edits of references to a name in a model from a file that includes the model.

    Args:
        text: the text of the file.
        file: the file that includes the model.
        model: the file of the model.
        path: the names from the model to the renamed element, or only the model's name if the model is renamed.
        new: the new name.
    """
    if model.parent.name not in text and model.name not in text:
        return
    elements = source_elements(text)
    for include in elements:
        if include.name != "include" or not _includes(include, text, model):
            continue
        include_name = _read_child_text(include, "name", text)
        scope = _find_scope(include.parent)
        if include_name and len(path) == 1:  # The include assigns another name to the model.
            continue
        names = [include_name or path[0], *path[1:]]
        for element in elements if scope is not None else ():
            for value, start, own in _find_references(element, text):
                if own is scope and value.split(_SEPARATOR)[: len(names)] == names:
                    begin = start + sum(len(name) + len(_SEPARATOR) for name in names[:-1])
                    yield Edit(file, begin, begin + len(names[-1]), new)


def _includes(include: SourceElement, text: str, model: Path) -> bool:
    uri = _read_child_text(include, "uri", text).rstrip("/")
    return uri.rpartition("/")[2] in (model.parent.name, model.name) and real_path(model).is_file()


def _read_child_text(element: SourceElement, tag: str, text: str) -> str:
    child = next((candidate for candidate in element.children if candidate.name == tag), None)
    return "" if child is None else text[child.tag.end : text.find("<", child.tag.end)].strip()
