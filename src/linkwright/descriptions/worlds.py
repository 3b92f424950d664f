"""Read a file as a world or model in SDF, with its includes and its findings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, has_errors, phrase
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages import PackageFinder
from linkwright.urdf import Reading
from linkwright.xmltree import Document, Overlay
from linkwright.xmltree.reader import read_bytes

if TYPE_CHECKING:
    from linkwright.sdf.worlds import Sdf

_OF_A_KIND = frozenset({"SDF150", "SDF160"})
_MOST_LINKS = 100_000
"""No more are read of a world: more would take minutes, and gigabytes."""
_ENDINGS = (".world", ".sdf", ".world.xacro", ".sdf.xacro")


@dataclass(frozen=True, eq=False)
class WorldDescription:
    """A world or model in SDF, read.

    Attributes:
        path: the file.
        sdf: its content, with included models in place of the includes, and materials with the colours of their
            scripts; None if it is not SDF.
        diagnostics: all findings about it and its included models.
        files: the files that were read, the main file first.
    """

    path: Path
    sdf: Sdf | None
    diagnostics: tuple[Diagnostic, ...]
    files: tuple[Path, ...]


def is_world(name: str) -> bool:
    """Return whether to read a file as SDF, by its name."""
    return name.endswith(_ENDINGS)


def examine_world(
    path: str | Path,
    *,
    arguments: Mapping[str, str] | None = None,
    packages: Mapping[str, str | Path] | PackageFinder | None = None,
    environment: Mapping[str, str] | None = None,
    overlay: Overlay | None = None,
) -> WorldDescription:
    """Read a world or model in SDF, or in SDF that xacro makes, with all findings about it.

    Args:
        path: the file; one whose name ends in ``.xacro``, or that has tags of xacro, is expanded first.
        arguments: values for the file's ``<xacro:arg>``.
        packages: package name -> share folder, or a finder.
        environment: the variables with search paths (`linkwright.sdf.resources`); those of the process by default.
        overlay: texts that replace those of files.

    Raises:
        LinkwrightError: it is not XML, it cannot be expanded, or it has more links than are read (SDF163).
    """
    from dataclasses import replace

    from linkwright.sdf.includes import resolve_includes
    from linkwright.sdf.reader import read
    from linkwright.sdf.references import check_references
    from linkwright.sdf.resources import ResourceFinder
    from linkwright.sdf.scripts import with_scripts
    from linkwright.sdf.worlds import populated

    path = Path(path)
    finder = (
        packages
        if isinstance(packages, PackageFinder)
        else PackageFinder(start=[path.absolute().parent, Path.cwd()], extra=packages)
    )
    document, remarks, files = _document(path, arguments, finder, overlay)
    reading = read(document)
    found = [*remarks, *reading.diagnostics]
    if reading.sdf is None:
        return WorldDescription(path, None, tuple(found), files)
    resources = ResourceFinder(finder, environment)
    included = resolve_includes(reading.sdf, path, resources)
    found += [*included.diagnostics, *check_references(included.sdf)]
    sdf = with_scripts(replace(included.sdf, worlds=tuple(map(populated, included.sdf.worlds))), resources)
    return WorldDescription(path, sdf, tuple(_each_once(found)), (*files, *included.files))


def robot_of_text(text: str, name: str) -> Reading:
    """Read the robot of a text in SDF; if there is one, the findings leave out warnings that gz would print.

    Args:
        text: the text.
        name: its file name in messages.
    """
    from linkwright.sdf.includes import resolve_includes
    from linkwright.sdf.reader import read
    from linkwright.sdf.resources import ResourceFinder
    from linkwright.sdf.text import parse_as_gazebo
    from linkwright.sdf.to_urdf import robot_from_sdf

    document, _ = parse_as_gazebo(text, name)
    reading = read(document)
    if reading.sdf is None or has_errors(reading.diagnostics):
        return Reading(None, reading.diagnostics)
    resources = ResourceFinder(PackageFinder(start=[Path.cwd()]))
    return robot_from_sdf(resolve_includes(reading.sdf, Path(name), resources).sdf, document.root)


def _each_once(found: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield the findings, only the first about each kind of unread element and each missing model."""
    reported: set[str] = set()
    for diagnostic in found:
        words = f"{diagnostic.code} {diagnostic.severity} {diagnostic.message}"
        if diagnostic.code not in _OF_A_KIND or words not in reported:
            reported.add(words)
            yield diagnostic


def _document(
    path: Path, arguments: Mapping[str, str] | None, finder: PackageFinder, overlay: Overlay | None
) -> tuple[Document, tuple[Diagnostic, ...], tuple[Path, ...]]:
    """Return the document, the diagnostics of reading it, and the files it was made of."""
    text = None if overlay is None else overlay.text(str(path))
    if path.suffix != ".xacro":
        document, warnings = _as_written(path, read_bytes(path) if text is None else text)
        if not _is_xacro(document):
            return document, warnings, (path,)
    from linkwright.xacro import expand

    expansion = expand(str(path), arguments, packages=finder, text=text, overlay=overlay)
    return expansion.document, expansion.diagnostics, expansion.dependencies


def _as_written(path: Path, written: str | bytes) -> tuple[Document, tuple[Diagnostic, ...]]:
    from linkwright.sdf.link_counts import has_more_links
    from linkwright.sdf.text import parse_as_gazebo

    if has_more_links(written, _MOST_LINKS):
        message = phrase(
            "'{path}' is not read: it has more than {most} links", path=display_path(path), most=_MOST_LINKS
        )
        hint = phrase("shapes that never move may be in one link")
        raise LinkwrightError(Diagnostic("SDF163", message, hint=hint))
    return parse_as_gazebo(written, str(path))


def _is_xacro(document: Document) -> bool:
    """Return whether a file is written for xacro, whatever its name: launch files expand it before Gazebo gets it."""
    root = document.root
    return "xmlns:xacro" in root.attributes and any(element.tag.startswith("xacro:") for element in root.walk())
