"""Read a description: only this module decides whether it is xacro or plain URDF."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from linkwright.descriptions.library import TRUE_OF_PARTS, Description
from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Severity, has_errors, phrase
from linkwright.diagnostics.source import TEXT_NAME, is_text
from linkwright.loading.lean_typing import TYPE_CHECKING, Union
from linkwright.urdf import Reading, Robot, read
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.xmltree import Document, Element, Overlay
from linkwright.xmltree.collection import seldom_collected
from linkwright.xmltree.reader import read_bytes

if TYPE_CHECKING:
    from linkwright.packages import PackageFinder

_URDF = ".urdf"
"""The ending of files that robot_state_publisher may be given as they are, whatever prefixes they declare."""

_LEFT_OVER = "URDF102"
"""Tags of xacro that were not evaluated."""

Packages = Union[Mapping[str, str | Path], "PackageFinder", None]


def load(
    path_or_text: str | Path,
    *,
    arguments: Mapping[str, str] | None = None,
    packages: Packages = None,
) -> Robot:
    """The robot of a URDF or xacro file or text.

    A link part that urdfdom would drop with an error message is dropped here too, silently; `examine` tells.

    Args:
        path_or_text: a path, or a text, which is known by its ``<``.
        arguments: values for the file's ``<xacro:arg>``.
        packages: for ``$(find)``: package name -> share folder, or a finder.

    Raises:
        LinkwrightError: it cannot be read or expanded, or urdfdom would refuse the model; with all findings.
    """
    with seldom_collected():
        description = examine(path_or_text, arguments=arguments, packages=packages)
    if description.robot is None:
        raise LinkwrightError(*description.diagnostics)
    return description.robot


def examine(
    path_or_text: str | Path,
    *,
    arguments: Mapping[str, str] | None = None,
    packages: Packages = None,
    overlay: Overlay | None = None,
    xacro: bool | None = None,
    partly: bool = False,
) -> Description:
    """Read a URDF, xacro or SDF file or text, with its robot and all findings; arguments as for `load`.

    Args:
        path_or_text: see `load`.
        arguments: see `load`.
        packages: see `load`.
        overlay: texts that replace those of files: of the file itself and of all files that it includes or loads.
        xacro: whether to expand it; None to decide by the file, see `is_xacro`. A plain URDF file is read as urdfdom
            reads it.
        partly: whether to accept the parts that can be expanded if others cannot; `Description.problems` then has the
            mistakes.

    Raises:
        LinkwrightError: it is not XML, or it cannot be expanded.
    """
    given_text = is_text(path_or_text)
    name = TEXT_NAME if given_text else str(path_or_text)
    text = str(path_or_text) if given_text else overlay.text(name) if overlay is not None else None
    if not xacro:
        document, forbidden = parse_as_urdfdom(read_bytes(name) if text is None else text, name)
        if document.root.tag == "sdf" and document.source is not None:
            from linkwright.descriptions.worlds import robot_of_text

            return Description(name, document, robot_of_text(document.source.text, name), overlay=overlay)
        if xacro is False or not (arguments or is_xacro(name, document.root)):
            return _as_it_stands(name, document, forbidden, overlay)
        text = document.source.text if given_text and document.source else text
    from linkwright.xacro import expand

    try:
        expansion = expand(name, arguments, packages=packages, text=text, overlay=overlay)
    except LinkwrightError as error:
        if not partly:
            raise
        if not xacro and not arguments and name.endswith(_URDF):
            told = {diagnostic.code for diagnostic in forbidden}
            unexpanded = tuple(
                _as_warning(diagnostic) for diagnostic in error.diagnostics if diagnostic.code not in told
            )
            plain = _as_it_stands(name, document, (*unexpanded, *forbidden), overlay, is_reported=bool(unexpanded))
            if plain.robot is not None and not has_errors(plain.diagnostics) and not _has_open_names(plain.robot):
                return plain
        from linkwright.xacro.inputs import Inputs
        from linkwright.xacro.parts import expand_parts

        expansion = expand_parts(Inputs(name, arguments or {}, packages, text, overlay=overlay), error)
    return Description.of_expansion(name, expansion, overlay)


def _as_it_stands(
    name: str,
    document: Document,
    remarks: tuple[Diagnostic, ...],
    overlay: Overlay | None,
    *,
    is_reported: bool = False,
) -> Description:
    """Return the description that urdfdom reads from an unexpanded document; `is_reported` if the remarks report that.

    Then xacro might add the elements that the file lacks, such as the colours of an included file.
    """
    reading = read(document)
    diagnostics = tuple(
        diagnostic for diagnostic in reading.diagnostics if not is_reported or _holds_unexpanded(diagnostic)
    )
    return Description(name, document, Reading(reading.robot, (*remarks, *diagnostics)), overlay=overlay)


def _holds_unexpanded(found: Diagnostic) -> bool:
    return found.severity is Severity.ERROR or (found.code in TRUE_OF_PARTS and found.code != _LEFT_OVER)


def _has_open_names(robot: Robot) -> bool:
    """Return whether names of links are to be completed by xacro: such a file is not meant for urdfdom."""
    return any("$(" in name or "${" in name for name in robot.links)


def _as_warning(error: Diagnostic) -> Diagnostic:
    """Return an error of the expansion as a warning, for a file that urdfdom reads unexpanded."""
    note = Note(phrase("urdfdom reads the file without expanding it, and ignores the elements of xacro"))
    return error.but(severity=Severity.WARNING, notes=(*error.notes, note))


def is_xacro(name: str, root: Element) -> bool:
    """Return whether to expand a document: by the name of its file, or because it declares the prefix of xacro."""
    return name.endswith(".xacro") or "xmlns:xacro" in root.attributes or root.tag.startswith("xacro:")
