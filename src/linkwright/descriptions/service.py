"""Read descriptions and worlds, and cache recently read descriptions.

`is_xacro` decides whether a file is expanded with xacro by default.
"""

from __future__ import annotations

import os
from collections import OrderedDict
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from functools import cached_property
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Severity, display_path, has_errors, phrase
from linkwright.diagnostics.diagnostic import TEXT_NAME, is_text
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import TYPE_CHECKING, Union
from linkwright.packages import PackageFinder
from linkwright.urdf import Reading, Robot, read
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.xmltree import Document, Element, Overlay
from linkwright.xmltree.nodes import seldom_collected
from linkwright.xmltree.reader import read_bytes

if TYPE_CHECKING:
    from linkwright.descriptions.unsaved import Listener, UnsavedTexts
    from linkwright.sdf.worlds import Sdf
    from linkwright.xacro import Expansion
    from linkwright.xacro.tracing.provenance import Provenance


HOLDS_FOR_PARTS = frozenset(
    {
        *("URDF101", "URDF102", "URDF110", "URDF120", "URDF121", "URDF122", "URDF123", "URDF124", "URDF130"),
        *("URDF131", "URDF132", "URDF140", "URDF162", "URDF170", "URDF190"),
    }
)
"""Findings of the reader that hold for a part of a robot. The other findings may be due to missing parts."""


@dataclass(frozen=True, eq=False)
class Description:
    """A parsed robot description.

    Attributes:
        name: the path as it was given, or `TEXT_NAME`.
        document: the expanded URDF document, whose elements have their source file and position.
        reading: the result of the URDF reader.
        expansion: the result of the xacro expansion, or None for plain URDF.
        overlay: texts that replaced the contents of files.
        problems: the errors because of which only parts of the description are available. If there are any, there is no
            robot.
    """

    name: str
    document: Document
    reading: Reading
    expansion: Expansion | None = None
    overlay: Overlay | None = None
    problems: tuple[Diagnostic, ...] = ()

    @classmethod
    def of_expansion(cls, name: str, expansion: Expansion, overlay: Overlay | None = None) -> Description:
        """Return the description of an expanded file.

        The description has a robot only if the expansion has no `problems`.
        """
        reading = read(expansion.document)
        if expansion.problems:
            reading = Reading(
                None, tuple(diagnostic for diagnostic in reading.diagnostics if diagnostic.code in HOLDS_FOR_PARTS)
            )
        return cls(name, expansion.document, reading, expansion, overlay, expansion.problems)

    @property
    def robot(self) -> Robot | None:
        """The robot, or None if urdfdom would refuse the model."""
        return self.reading.robot

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The problems, the remarks of xacro, and all findings of the reader."""
        return (*self.problems, *self.remarks, *self.reading.diagnostics)

    @property
    def remarks(self) -> tuple[Diagnostic, ...]:
        """The warnings of xacro, and the messages of ``xacro.message`` and similar functions."""
        return () if self.expansion is None else self.expansion.diagnostics

    @cached_property
    def text(self) -> str:
        """The URDF text, as published on topics and in parameters."""
        if self.expansion is not None:
            return str(self.expansion)
        return self.document.source.text if self.document.source is not None else ""

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that were read, starting with the main file, or no files for a text."""
        if self.expansion is not None:
            return self.expansion.dependencies
        return () if self.name.startswith("<") else (Path(self.name),)

    @cached_property
    def sources(self) -> Mapping[Path, Document]:
        """The unexpanded XML files that were read, by path, starting with the main file."""
        if self.expansion is None:
            return {Path(self.name): self.document}
        from linkwright.xacro.cache import read_document

        documents: dict[Path, Document] = {}
        for path in self.expansion.dependencies:
            with suppress(LinkwrightError):  # YAML files are also among the files, but are not XML
                documents[path] = read_document(str(path), self.overlay)
        return documents

    def provenance(self, element: Element) -> Provenance | None:
        """Return the macro calls and includes that produced an element, or None for plain URDF.

        Raises:
            LinkwrightError: XAC802 if the files have changed since they were read.
        """
        return None if self.expansion is None else self.expansion.provenance(element)


_MAX_TEXTS = 32


class DescriptionLibrary:
    """A cache of descriptions by their expanded texts, so that each text is read only once.

    The launcher stores each description that it expands. The nodes and the viewer, which only receive the text from a
    parameter or topic, can then find the location of each element in the source files.

    Attributes:
        unsaved_listeners: the functions that are called after each change of an unsaved text.
    """

    def __init__(self) -> None:
        self.unsaved_listeners: list[Listener] = []
        self._descriptions: OrderedDict[str, Description] = OrderedDict()
        self._finders: dict[str, PackageFinder] = {}

    @cached_property
    def unsaved(self) -> UnsavedTexts:
        """The unsaved texts of editors."""
        from linkwright.descriptions.unsaved import UnsavedTexts  # most views have no editor

        return UnsavedTexts(self.unsaved_listeners)

    @property
    def unsaved_texts(self) -> Mapping[str | os.PathLike[str], str]:
        """The unsaved texts of editors, by the real paths of their files."""
        if "unsaved" not in self.__dict__:
            return {}
        return {path: unsaved.text for path, unsaved in self.unsaved.texts.items()}

    def store(self, description: Description, text: str | None = None, packages: PackageFinder | None = None) -> str:
        """Store a description, so that it can be found by its text.

        Args:
            description: the description to store.
            text: the key under which to store it, or None for the description's own text.
            packages: the finder of the description's packages, if the rest of the program may use other packages.

        Returns:
            The text under which the description is stored.
        """
        text = description.text if text is None else text
        self._descriptions[text] = description
        self._descriptions.move_to_end(text)
        if packages is not None:
            self._finders[text] = packages
        if len(self._descriptions) > _MAX_TEXTS:
            self._finders.pop(self._descriptions.popitem(last=False)[0], None)
        return text

    def packages(self, text: str) -> PackageFinder | None:
        """Return the package finder of a stored description, or None if there is none."""
        return self._finders.get(text)

    def description(self, text: str) -> Description | None:
        """Return the stored description with a text, or None if there is none."""
        return self._descriptions.get(text)

    def files(self, text: str) -> tuple[Path, ...]:
        """Return the files of a stored description, the main file first, or an empty tuple."""
        description = self._descriptions.get(text)
        return () if description is None else description.files

    def provenance(self, text: str, element: Element) -> Provenance | None:
        """Return the macro calls and includes that produced an element of a stored description.

        The result is None for an unknown text.

        Raises:
            LinkwrightError: XAC802 if the files of the description have changed since they were read.
        """
        description = self._descriptions.get(text)
        return None if description is None else description.provenance(element)

    def read(self, text: str) -> Reading:
        """Return the reading of a text in plain URDF or SDF, from the cache if possible.

        If the text is not XML, the reading has no robot, and its diagnostics contain the reason.
        """
        description = self._descriptions.get(text)
        if description is None:
            description = _read(text)
            self.store(description, text)
        else:
            self._descriptions.move_to_end(text)
        return description.reading


def _read(text: str) -> Description:
    try:
        document, _ = parse_as_urdfdom(text, TEXT_NAME)
    except LinkwrightError as error:
        return Description(TEXT_NAME, Document(Element("robot")), Reading(None, error.diagnostics))
    if document.root.tag == "sdf":
        return Description(TEXT_NAME, document, robot_of_text(text, TEXT_NAME))
    return Description(TEXT_NAME, document, read(document))


_CODES_REPORTED_ONCE = frozenset({"SDF150", "SDF160"})
_MAX_LINKS = 100_000
"""The maximum number of links in a world. More links would take minutes and gigabytes to read."""
_WORLD_SUFFIXES = (".world", ".sdf", ".world.xacro", ".sdf.xacro")


@dataclass(frozen=True, eq=False)
class WorldDescription:
    """A parsed world or model in SDF.

    Attributes:
        path: the file.
        sdf: the content of the file, in which models replace the includes, and materials have the colors of their
            scripts. None if the file is not valid SDF.
        diagnostics: all findings about the file and its included models.
        files: the files that were read, starting with the main file.
    """

    path: Path
    sdf: Sdf | None
    diagnostics: tuple[Diagnostic, ...]
    files: tuple[Path, ...]


def is_world(name: str) -> bool:
    """Return whether a file with this name is read as SDF."""
    return name.endswith(_WORLD_SUFFIXES)


def examine_world(
    path: str | Path,
    *,
    arguments: Mapping[str, str] | None = None,
    packages: Mapping[str, str | Path] | PackageFinder | None = None,
    environment: Mapping[str, str] | None = None,
    overlay: Overlay | None = None,
) -> WorldDescription:
    """Return a world or model in SDF, or in SDF generated by xacro, with all findings about it.

    Args:
        path: the file. A file whose name ends in ``.xacro``, or that contains xacro tags, is expanded first.
        arguments: values for the file's ``<xacro:arg>``.
        packages: the packages, as a mapping of names to share folders, or a finder.
        environment: the variables with search paths (`linkwright.sdf.resources`); the default is the environment of the
            process.
        overlay: texts that replace the contents of files.

    Raises:
        LinkwrightError: if the file is not XML, cannot be expanded, or has too many links (SDF163).
    """
    from dataclasses import replace

    from linkwright.sdf.includes import resolve_includes
    from linkwright.sdf.reader import read
    from linkwright.sdf.references import check_references
    from linkwright.sdf.resources import ResourceFinder
    from linkwright.sdf.scripts import with_scripts
    from linkwright.sdf.worlds import with_populations

    path = Path(path)
    finder = (
        packages
        if isinstance(packages, PackageFinder)
        else PackageFinder(start=[path.absolute().parent, Path.cwd()], extra=packages)
    )
    document, remarks, files = _read_expanded(path, arguments, finder, overlay)
    reading = read(document)
    diagnostics = [*remarks, *reading.diagnostics]
    if reading.sdf is None:
        return WorldDescription(path, None, tuple(diagnostics), files)
    resources = ResourceFinder(finder, environment)
    resolution = resolve_includes(reading.sdf, path, resources)
    diagnostics += [*resolution.diagnostics, *check_references(resolution.sdf)]
    sdf = with_scripts(replace(resolution.sdf, worlds=tuple(map(with_populations, resolution.sdf.worlds))), resources)
    return WorldDescription(path, sdf, tuple(_remove_repetitions(diagnostics)), (*files, *resolution.files))


def robot_of_text(text: str, name: str) -> Reading:
    """Return the robot of an SDF text, and the findings.

    If the text has no errors, warnings that gz would print are left out of the findings.

    Args:
        text: the text of a model in SDF.
        name: the name of the file in messages.
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


def _remove_repetitions(diagnostics: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield the findings without repetitions about unread elements and missing models.

    Of repeated findings, only the first is yielded.
    """
    reported_keys: set[str] = set()
    for diagnostic in diagnostics:
        key = f"{diagnostic.code} {diagnostic.severity} {diagnostic.message}"
        if diagnostic.code not in _CODES_REPORTED_ONCE or key not in reported_keys:
            reported_keys.add(key)
            yield diagnostic


def _read_expanded(
    path: Path, arguments: Mapping[str, str] | None, finder: PackageFinder, overlay: Overlay | None
) -> tuple[Document, tuple[Diagnostic, ...], tuple[Path, ...]]:
    """Return the document of a file, its diagnostics, and the files that were read."""
    text = None if overlay is None else overlay.text(str(path))
    if path.suffix != ".xacro":
        document, warnings = _parse_world(path, read_bytes(path) if text is None else text)
        if not _is_xacro(document):
            return document, warnings, (path,)
    from linkwright.xacro import expand

    expansion = expand(str(path), arguments, packages=finder, text=text, overlay=overlay)
    return expansion.document, expansion.diagnostics, expansion.dependencies


def _parse_world(path: Path, content: str | bytes) -> tuple[Document, tuple[Diagnostic, ...]]:
    from linkwright.sdf.link_counts import has_more_links
    from linkwright.sdf.text import parse_as_gazebo

    if has_more_links(content, _MAX_LINKS):
        message = phrase(
            "'{path}' is not read: it has more than {maximum} links", path=display_path(path), maximum=_MAX_LINKS
        )
        hint = phrase("put shapes that never move into one link")
        raise LinkwrightError(Diagnostic("SDF163", message, hint=hint))
    return parse_as_gazebo(content, str(path))


def _is_xacro(document: Document) -> bool:
    """Return whether a document contains xacro tags, regardless of the name of its file.

    Launch files expand such a file before Gazebo reads it.
    """
    root = document.root
    return "xmlns:xacro" in root.attributes and any(element.tag.startswith("xacro:") for element in root.walk())


_URDF_SUFFIX = ".urdf"
"""The suffix of files that robot_state_publisher may read unexpanded, whatever prefixes they declare."""

_UNEVALUATED_TAG_CODE = "URDF102"
"""The finding about a xacro tag that was not evaluated."""

Packages = Union[Mapping[str, str | Path], "PackageFinder", None]


def load(
    path_or_text: str | Path,
    *,
    arguments: Mapping[str, str] | None = None,
    packages: Packages = None,
) -> Robot:
    """Return the robot of a URDF or xacro file or text.

    A part of a link that urdfdom would drop with an error message is dropped silently; `examine` reports it.

    Args:
        path_or_text: the path of a file, or a text, which is recognized by its ``<``.
        arguments: values for the file's ``<xacro:arg>``.
        packages: the packages for ``$(find)``, as a mapping of names to share folders, or a finder.

    Raises:
        LinkwrightError: all findings, if the description cannot be read or expanded, or if urdfdom would refuse the
            model.
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
    """Return a URDF, xacro or SDF file or text as a description with all findings.

    Args:
        path_or_text: see `load`.
        arguments: see `load`.
        packages: see `load`.
        overlay: texts that replace the contents of the file, or of files that it includes or loads.
        xacro: whether to expand the file with xacro; None to expand it if there are arguments or `is_xacro` returns
            true. A plain URDF file is read as urdfdom reads it.
        partly: whether to accept the parts that can be expanded if others cannot. `Description.problems` then contains
            the errors.

    Raises:
        LinkwrightError: if the description is not XML, or cannot be expanded.
    """
    is_text_input = is_text(path_or_text)
    name = TEXT_NAME if is_text_input else str(path_or_text)
    text = str(path_or_text) if is_text_input else overlay.text(name) if overlay is not None else None
    if not xacro:
        document, remarks = parse_as_urdfdom(read_bytes(name) if text is None else text, name)
        if document.root.tag == "sdf" and document.source is not None:
            return Description(name, document, robot_of_text(document.source.text, name), overlay=overlay)
        if xacro is False or not (arguments or is_xacro(name, document.root)):
            return _make_unexpanded_description(name, document, remarks, overlay)
        text = document.source.text if is_text_input and document.source else text
    from linkwright.xacro import expand

    try:
        expansion = expand(name, arguments, packages=packages, text=text, overlay=overlay)
    except LinkwrightError as error:
        if not partly:
            raise
        if not xacro and not arguments and name.endswith(_URDF_SUFFIX):
            reported_codes = {diagnostic.code for diagnostic in remarks}
            expansion_warnings = tuple(
                _to_warning(diagnostic) for diagnostic in error.diagnostics if diagnostic.code not in reported_codes
            )
            plain_description = _make_unexpanded_description(
                name, document, (*expansion_warnings, *remarks), overlay, is_reported=bool(expansion_warnings)
            )
            if (
                plain_description.robot is not None
                and not has_errors(plain_description.diagnostics)
                and not _has_unexpanded_names(plain_description.robot)
            ):
                return plain_description
        from linkwright.xacro.parts import expand_parts
        from linkwright.xacro.session import Inputs

        expansion = expand_parts(Inputs(name, arguments or {}, packages, text, overlay=overlay), error)
    return Description.of_expansion(name, expansion, overlay)


def _make_unexpanded_description(
    name: str,
    document: Document,
    remarks: tuple[Diagnostic, ...],
    overlay: Overlay | None,
    *,
    is_reported: bool = False,
) -> Description:
    """Return the description that urdfdom reads from an unexpanded document.

    If `is_reported` is true, the remarks already report that the document is not expanded. Findings about missing parts
    are then left out, because xacro might add these parts, such as the colors of an included file.
    """
    reading = read(document)
    diagnostics = tuple(
        diagnostic for diagnostic in reading.diagnostics if not is_reported or _has_unexpanded_text(diagnostic)
    )
    return Description(name, document, Reading(reading.robot, (*remarks, *diagnostics)), overlay=overlay)


def _has_unexpanded_text(diagnostic: Diagnostic) -> bool:
    return diagnostic.severity is Severity.ERROR or (
        diagnostic.code in HOLDS_FOR_PARTS and diagnostic.code != _UNEVALUATED_TAG_CODE
    )


def _has_unexpanded_names(robot: Robot) -> bool:
    """Return whether link names contain xacro expressions.

    A file with such names is not intended for urdfdom.
    """
    return any("$(" in name or "${" in name for name in robot.links)


def _to_warning(error: Diagnostic) -> Diagnostic:
    """Return an error of the expansion as a warning, for a file that urdfdom reads unexpanded."""
    note = Note(phrase("urdfdom reads the file without expanding it, and ignores the elements of xacro"))
    return error.with_changes(severity=Severity.WARNING, notes=(*error.notes, note))


def is_xacro(name: str, root: Element) -> bool:
    """Return whether to expand a document with xacro.

    This is the case if the name of the file ends in ``.xacro``, or if the root declares or uses the xacro prefix.
    """
    return name.endswith(".xacro") or "xmlns:xacro" in root.attributes or root.tag.startswith("xacro:")
