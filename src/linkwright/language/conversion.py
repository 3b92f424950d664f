"""Convert a URDF file to a new xacro file in the same folder."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, display_path, phrase
from linkwright.language.proof import UnprovedError
from linkwright.language.source_elements import source_elements
from linkwright.language.workspace import Workspace
from linkwright.lint.rules.xacro_tags import NAMESPACE_URI
from linkwright.loading.deferred import lazy_pattern
from linkwright.xacro import expand
from linkwright.xmltree import Element, Overlay, parse
from linkwright.xmltree.tokens import Kind, tokens

_DOLLARS_BEFORE_BRACKET = lazy_pattern(r"\$+(?=[{(])")


@dataclass(frozen=True, slots=True)
class NewFile:
    """A file that does not exist yet, and its text."""

    file: Path
    text: str


def can_be_converted(text: str, file: Path) -> bool:
    """Return whether a file is plain URDF, without xacro."""
    if not file.name.endswith(".urdf"):
        return False
    root = next(iter(source_elements(text)), None)
    return root is not None and root.name == "robot" and "xmlns:xacro" not in root.tag.text


def convert_to_xacro(workspace: Workspace, texts: Mapping[Path, str], file: Path, text: str) -> NewFile:
    """Return a new xacro file that expands to the same elements as a URDF file.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        file: the URDF file.
        text: its text.

    Raises:
        UnprovedError: the new file exists or is outside the workspace, the URDF is invalid, or the expansion would
            differ from it.
    """
    new = file.with_name(f"{file.name}.xacro")
    if new.exists() or new in texts:
        raise UnprovedError(phrase("'{file}' already exists", file=display_path(str(new))))
    if not workspace.contains(new):
        raise UnprovedError(phrase("'{file}' is outside the workspace", file=display_path(str(new))))
    root = next(iter(source_elements(text)), None)
    if root is None:
        raise UnprovedError(phrase("the file has no element"))
    insertion_offset = root.tag.name_start + len(root.name)
    name = next((attribute for attribute in root.tag.attributes() if attribute.name == "name"), None)
    insertion_offset = insertion_offset if name is None else name.end
    xacro_text = f'{_escape(text[:insertion_offset])} xmlns:xacro="{NAMESPACE_URI}"{_escape(text[insertion_offset:])}'
    try:
        overlay = Overlay({str(new): xacro_text})
        expansion = str(expand(new, {}, packages=workspace.finder(file), overlay=overlay))
        first, second = (_comparable_elements(parse(source, file.name).root) for source in (text, expansion))
    except LinkwrightError as error:
        raise UnprovedError(error.diagnostics[0].message, error.diagnostics[0].span) from None
    if first != second:
        raise UnprovedError(phrase("the robot of '{file}' would change", file=file.name))
    return NewFile(new, xacro_text)


def _escape(text: str) -> str:
    """Escape the dollar signs before brackets for xacro, except in comments."""
    return "".join(
        token.text
        if token.kind is Kind.COMMENT
        else _DOLLARS_BEFORE_BRACKET.sub(lambda dollars: f"${dollars[0]}", token.text)
        for token in tokens(text)
    )


def _comparable_elements(root: Element) -> list[tuple[object, ...]]:
    """Return the tag, attributes and text of each element, without the xacro namespace."""
    return [
        (
            element.tag,
            tuple(sorted(item for item in element.attributes.items() if item[0] != "xmlns:xacro")),
            " ".join(element.text().split()),
        )
        for element in root.walk()
    ]
