"""Completion and hover for packages, executables, components and files in launch files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.completion import Completion, ItemKind
from linkwright.language.format import Document, Target
from linkwright.language.hover_facts import describe_mesh, describe_package
from linkwright.language.node_topics import NodeProgram, describe_topic, find_topics
from linkwright.language.programs import find_components, find_programs, package_names, replaced_packages
from linkwright.messages.definitions.interfaces import is_package_name
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.share_layout import find_source

_MAX_SHOWN_FILES = 300
_MAX_SHOWN_TOPICS = 20
_LAUNCH_SUFFIXES = (".launch.py", ".launch.xml", ".launch.yaml", ".launch", "_launch.py", "_launch.xml", "_launch.yaml")


def offer_packages(document: Document, start: int) -> Iterator[Completion]:
    """Yield all packages: the file's own first, then its dependencies, then the others.

    Args:
        document: the text.
        start: the offset from which the typed text is replaced.
    """
    folders, replaced = document.finder.packages(), replaced_packages()
    for name in package_names(document.finder, document.file):
        origin = folders.get(name) or ("Linkwright" if name in replaced else MANIFEST)
        yield Completion(name, ItemKind.PACKAGE, start, str(origin))


def offer_programs(document: Document, package: str | None, start: int) -> Iterator[Completion]:
    """Yield the executables of a package, or nothing if the package is None."""
    for program in find_programs(document.finder, package).values() if package else ():
        yield Completion(program.name, ItemKind.FUNCTION, start, program.origin)


def offer_components(document: Document, package: str | None, start: int) -> Iterator[Completion]:
    """Yield the components of a package, or nothing if the package is None."""
    for name in find_components(document.finder, package) if package else ():
        yield Completion(name, ItemKind.FUNCTION, start, package or "")


def offer_values(values: Iterable[str], start: int) -> Iterator[Completion]:
    """Yield fixed values."""
    for value in values:
        yield Completion(value, ItemKind.VALUE, start)


def offer_files(base: Path, typed: str, offset: int, *, launch_files: bool = False) -> Iterator[Completion]:
    """Yield the visible files and folders that continue a typed path, folders first.

    Args:
        base: the folder that the path starts at.
        typed: the typed part of the path.
        offset: the offset of the cursor, which is the end of the typed part.
        launch_files: whether launch files come before everything else.
    """
    subfolder, _, name = typed.rpartition("/")
    try:
        entries = [entry for entry in (base / subfolder.lstrip("/")).iterdir() if not entry.name.startswith(".")]
        names = [(entry.is_file(), entry.name) for entry in entries]
    except (OSError, ValueError):
        return
    names.sort(key=lambda entry: (launch_files and not entry[1].endswith(_LAUNCH_SUFFIXES), *entry))
    for is_file, entry_name in names[:_MAX_SHOWN_FILES]:
        yield Completion(entry_name, ItemKind.FILE if is_file else ItemKind.FOLDER, offset - len(name))


def explain_package(document: Document, name: str) -> str | None:
    """Return facts about a package in Markdown, or None if the text is not a package name."""
    folder = document.finder.find(name)
    if folder is None:
        return localized(phrase("package '{name}' not found", name=name)) if is_package_name(name) else None
    if not folder.is_dir():
        return localized(phrase("**{name}**: nodes and modules of Linkwright replace this package", name=name))
    return describe_package(document.finder, name)


def explain_program(document: Document, package: str | None, name: str) -> str | None:
    """Return the origin and the interfaces of an executable in Markdown, or None.

    The interfaces are its topics, services and actions. The result is None for an unknown executable.
    """
    program = find_programs(document.finder, package).get(name) if package else None
    if package is None or program is None:
        return None
    topics = find_topics(document, [NodeProgram(package, name)])[:_MAX_SHOWN_TOPICS]
    return f"**{package} {name}**: `{program.origin}`\n\n" + "\n".join(f"- {describe_topic(topic)}" for topic in topics)


def explain_file(path: Path) -> str:
    """Return the path of a file, or the facts about a mesh, in Markdown."""
    if not path.exists():
        return localized(phrase("`{path}` does not exist", path=path))
    return describe_mesh(path) or f"`{path}`"


def target_of_package(document: Document, name: str) -> Iterator[Target]:
    """Yield the ``package.xml`` of a package."""
    folder = document.finder.find(name)
    if folder is not None and (folder / MANIFEST).is_file():
        yield Target(Path(find_source(str(folder / MANIFEST))))


def target_of_program(document: Document, package: str | None, name: str) -> Iterator[Target]:
    """Yield the source of an executable."""
    program = find_programs(document.finder, package).get(name) if package else None
    if program is not None and program.target is not None:
        yield program.target


def target_of_component(document: Document, package: str | None, name: str) -> Iterator[Target]:
    """Yield the location where a package registers a component."""
    target = find_components(document.finder, package).get(name) if package else None
    if target is not None:
        yield target


def target_of_file(path: Path | None) -> Iterator[Target]:
    """Yield a file, if it exists."""
    if path is not None and path.is_file():
        yield Target(Path(find_source(str(path))))
