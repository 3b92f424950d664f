"""Edits that fill in the inertia of a link, computed from its shapes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.inertia import MeshLibrary, estimate
from linkwright.inertia.source_edits import EXPRESSION, NotWritableError
from linkwright.inertia.writing import create_link_edits
from linkwright.language.expanded import expand_to_robots, is_source_of
from linkwright.language.grammar import PREFIX
from linkwright.language.proof import Edit, ExpansionProof, UnprovedError
from linkwright.language.source_elements import SourceElement, find_innermost_element, source_elements
from linkwright.language.workspace import Workspace
from linkwright.urdf import Link, Robot
from linkwright.xmltree import Element


def link_with_shapes_at(text: str, offset: int) -> SourceElement | None:
    """Return the link around an offset if it has shapes without expressions, or None."""
    element = find_innermost_element(source_elements(text), offset)
    link = (
        None
        if element is None
        else next((candidate for candidate in element.ancestors_and_self() if candidate.name == "link"), None)
    )
    if link is None or any(child.name.startswith(PREFIX) for child in link.children):
        return None
    shapes = [child for child in link.children if child.name in ("visual", "collision")]
    parts = [part for shape in shapes for part in shape.children if part.name in ("origin", "geometry")]
    return link if parts and not any(EXPRESSION.search(text, part.start, part.end) for part in parts) else None


def fill_in_inertia(
    workspace: Workspace, texts: Mapping[Path, str], file: Path, text: str, link: SourceElement
) -> tuple[Edit, ...]:
    """Return the edits that set the inertia of a link to the inertia of its shapes.

    The expansions stay equal otherwise. The mass is the mass of the link or, if it has none, the mass of water with
    the same shapes, as in `linkwright inertia`.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        file: the file that contains the link.
        text: its text.
        link: a link, as `link_with_shapes_at` returns it.

    Raises:
        UnprovedError: no expansion contains the link, its inertia is unknown or cannot be written, or something else
            would change.
    """
    robot, entry, expanded_link = _find_expanded_link(workspace, texts, file, link)
    finder = workspace.finder(entry)
    properties = estimate(expanded_link, MeshLibrary(finder, entry.parent)).properties
    if properties is None:
        raise UnprovedError(phrase("no shape of the link '{name}' has a volume", name=expanded_link.name))
    try:
        source, replacements = create_link_edits(robot, expanded_link.name, properties)
    except NotWritableError as error:
        raise UnprovedError(error.args[0]) from None
    if source.text != text:
        raise UnprovedError(phrase("'{file}' has changed since it was read", file=file.name))
    edits = tuple(Edit(file, replacement.start, replacement.end, replacement.text) for replacement in replacements)
    if not edits:
        raise UnprovedError(phrase("the link '{name}' already has this inertia", name=expanded_link.name))
    for pair in ExpansionProof(workspace, texts, file).pairs(edits):
        first, second = (_without_inertial(root, expanded_link.name) for root in (pair.before, pair.after))
        if first != second:
            raise UnprovedError(phrase("the robot of '{file}' would change", file=pair.entry.name))
    return edits


def _find_expanded_link(
    workspace: Workspace, texts: Mapping[Path, str], file: Path, link: SourceElement
) -> tuple[Robot, Path, Link]:
    for entry, robot in expand_to_robots(workspace, texts, file):
        expanded_link = next(
            (candidate for candidate in robot.links.values() if is_source_of(file, link.start, candidate.element)), None
        )
        if expanded_link is not None:
            return robot, entry, expanded_link
    raise UnprovedError(phrase("no description that can be expanded has this link"))


def _without_inertial(root: Element, name: str) -> list[tuple[str, tuple[tuple[str, str], ...], str]]:
    """Return the elements of a robot, except the inertia of one link."""
    elements = []
    pending = [root]
    while pending:
        element = pending.pop()
        elements.append((element.tag, tuple(element.attributes.items()), element.text().strip()))
        is_link = element.tag == "link" and element.attributes.get("name") == name
        pending += [child for child in element.elements() if not (is_link and child.tag == "inertial")]
    return elements
