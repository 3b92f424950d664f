"""Compare the packages and headers of other packages that sources include or import."""

from __future__ import annotations

import re
import sys
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from linkwright.diagnostics import Phrase, SourceText, Span, joined_first, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.manifest import package_name
from linkwright.review.changes import MAX_NAMES
from linkwright.review.sources.names import CPP_SUFFIXES, HEADER_SUFFIXES, PYTHON_SUFFIX
from linkwright.review.sources.reading import is_program_text, try_read_source, try_read_text
from linkwright.review.versions import TEST_FOLDERS, Version

_BLOCK_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_INCLUDE = re.compile(
    r'^[ \t]*#[ \t]*include[ \t]*["<](?:google/(?=\w+/))?(?P<name>[\w.+-]+/[^">\n]+)[">]', re.MULTILINE
)
"""An included header. The folder ``google`` has those of several libraries, such as ``google/protobuf/message.h``."""
_IMPORT = re.compile(
    r"^[ \t]*(?:from[ \t]+(?P<source>[A-Za-z_]\w*)[\w.]*[ \t]+import\b|import[ \t]+(?P<names>[\w., \t]+))", re.MULTILINE
)
_MESSAGE = re.compile(r"/(?:msg|srv|action)/|_(?:msgs|srvs|actions)/")
"""A part of the path of a header of messages."""
_MESSAGE_PACKAGE = re.compile(r"_(?:msgs?|srvs?|actions?|interfaces?)$")
"""The end of the name of a package of messages, which serves sources in C++ and Python."""
_SYSTEM_FOLDERS = frozenset(
    {*("arpa", "asm", "bits", "experimental", "ext", "linux", "mach", "net", "netinet", "sys", "tr1", "tr2")}
)
"""The folders of headers of the operating system and the compiler."""
_CLIENT_LIBRARIES = frozenset({"rclcpp", "rclpy", "ros", "rospy"})
"""The packages that every node uses."""
_OLD_MODULES = frozenset(
    {*("ConfigParser", "Queue", "SocketServer", "StringIO", "Tkinter", "cPickle", "cStringIO", "commands"),
     *("exceptions", "future_builtins", "httplib", "md5", "sets", "thread", "tkMessageBox", "urllib2", "urlparse")}
)  # fmt: skip
"""Modules of the standard library of Python 2."""
_STANDARD_MODULES = sys.stdlib_module_names | _OLD_MODULES | {"__future__"}


class UsageChange(NamedTuple):
    """A change to the packages or headers that a source uses.

    Attributes:
        text: the change in one line.
        span: the location of the first include or import.
        is_old: whether the location is in the old version.
    """

    text: Phrase
    span: Span
    is_old: bool


class UsedPackages:
    """The packages that the sources of a package use, in one version.

    Args:
        version: the version of the repository.
        package: the folder of the package.
        new_packages: the new names of packages that are renamed after this version, by old name.
    """

    def __init__(self, version: Version, package: str, new_packages: Mapping[str, str]) -> None:
        self._version = version
        self._new_packages = new_packages
        self._package = package
        self._reported: set[str] = set()
        self._sources: dict[bool, Mapping[str, Sequence[str]]] = {}
        self._read: dict[str, frozenset[str]] = {}
        self._own: frozenset[str] | None = None

    def read(self, path: str) -> dict[str, Span]:
        """Return the headers or modules of other packages that a source uses, each with its first location."""
        return {name: span for name, span in self.read_all(path).items() if get_package(name) not in self._own_names}

    def read_all(self, path: str) -> dict[str, Span]:
        """Return the headers or modules that a source uses, also those of its own package."""
        source = try_read_source(self._version.file(path))
        if source is None:
            return {}
        return _read_imports(source) if is_python_source(path) else _read_includes(source)

    def rename(self, name: str) -> str:
        """Return a package, header or module with the new name of its package."""
        package = get_package(name)
        return f"{self._new_packages.get(package, package)}{name[len(package) :]}"

    def uses(self, name: str, *, is_python: bool) -> bool:
        """Return whether a source of the package uses a package, header or module."""
        package = get_package(name)
        packages = [package, *(old for old, new in self._new_packages.items() if new == package)]
        sources = self._find_sources(is_python=is_python)
        return any(name in self._list_names(path) for used in packages for path in sources.get(used, ()))

    def _find_sources(self, *, is_python: bool) -> Mapping[str, Sequence[str]]:
        """Return the sources that seem to use each package, which those in comments do, too.

        To read all sources of a package takes too long.
        """
        if is_python not in self._sources:
            sources = defaultdict(list)
            paths = self._list_python_sources() if is_python else self._version.paths(CPP_SUFFIXES, self._package)
            for path in filter(_is_searched, paths):
                for package in _find_packages(self._version.file(path), is_python=is_python):
                    sources[package].append(path)
            self._sources[is_python] = sources
        return self._sources[is_python]

    def _list_names(self, path: str) -> frozenset[str]:
        """Return the packages, headers and modules that a source uses, by their old and new names."""
        if path not in self._read:
            names = {text for name in self.read(path) for text in (name, self.rename(name))}
            self._read[path] = frozenset(names | {get_package(name) for name in names})
        return self._read[path]

    def claim(self, name: str) -> bool:
        """Return whether a package or header is not reported yet, and mark it as reported."""
        is_new = name not in self._reported
        self._reported.add(name)
        return is_new

    def _list_python_sources(self) -> Iterator[str]:
        """Yield the modules of the package, and its scripts without a suffix."""
        for path in self._version.paths(("",), self._package):
            suffix = PurePosixPath(path).suffix
            if suffix == PYTHON_SUFFIX or (not suffix and is_program_text(self._version.file(path))):
                yield path

    @property
    def _own_names(self) -> frozenset[str]:
        """The names that mean headers and modules of the package, and of client libraries."""
        if self._own is None:
            paths = [
                PurePosixPath(path) for path in self._version.paths((*HEADER_SUFFIXES, PYTHON_SUFFIX), self._package)
            ]
            root = len(PurePosixPath(self._package).parts)
            folders = {part for path in paths for part in path.parts[root:-1]}
            modules = {path.stem for path in paths if path.suffix == PYTHON_SUFFIX}
            name = package_name(self._version.file(self._package))
            self._own = frozenset(folders | modules | _CLIENT_LIBRARIES | ({name} if name else set()))
        return self._own


def is_python_source(path: str) -> bool:
    """Return whether a source is in Python, by its path: a module, or a script without a suffix."""
    return PurePosixPath(path).suffix in (PYTHON_SUFFIX, "")


def get_package(name: str) -> str:
    """Return the package of a header or module: its first word."""
    return re.split(r"[/.]", name, maxsplit=1)[0]


def compare_usage(
    old: UsedPackages | None, new: UsedPackages | None, file: ChangedFile, *, are_headers_told: bool
) -> Iterator[UsageChange]:
    """Yield the packages that a source is the first to use in its package, or the last that used them.

    Args:
        old: the packages that the old version uses; None for a source outside of packages.
        new: the packages that the new version uses; None for a source outside of packages.
        file: the paths of the source.
        are_headers_told: whether to yield headers of packages in use, too.
    """
    if old is None or new is None:
        return
    yield from _compare_packages(old, new, file.old_path, file.new_path)
    is_header_told = are_headers_told and not is_python_source(file.path)
    if is_header_told and file.old_path is not None and file.new_path is not None:
        yield from _compare_headers(old, new, file.old_path, file.new_path)


def _compare_packages(
    old: UsedPackages, new: UsedPackages, old_path: str | None, new_path: str | None
) -> Iterator[UsageChange]:
    is_python = is_python_source(new_path or old_path or "")
    for sides, path, other_path, is_old in (
        ((new, old), new_path, old_path, False),
        ((old, new), old_path, new_path, True),
    ):
        if path is None:
            continue
        uses = {get_package(name): span for name, span in reversed(sides[0].read(path).items())}
        packages = [
            name
            for name in reversed(uses)
            if not any(
                _uses(*sides, name, is_python=language)
                for language in ((True, False) if _MESSAGE_PACKAGE.search(name) else (is_python,))
            )
        ]
        if packages and other_path is not None:  # now in the package, or before
            kept = {
                get_package(other) for name in sides[1].read_all(other_path) for other in (name, sides[1].rename(name))
            }
            packages = [name for name in packages if kept.isdisjoint((name, sides[0].rename(name)))]
        packages = [name for name in packages if sides[0].claim(name)]
        if packages:
            names = joined_first([f"'{name}'" for name in packages], MAX_NAMES)
            yield UsageChange(_format_packages(names, is_python=is_python, is_old=is_old), uses[packages[0]], is_old)


def _compare_headers(old: UsedPackages, new: UsedPackages, old_path: str, new_path: str) -> Iterator[UsageChange]:
    """Yield the headers of packages in use that a C++ source is the first to include, or the last that included them.

    Headers of messages are left out.
    """
    for sides, path, is_old in (((new, old), new_path, False), ((old, new), old_path, True)):
        uses = {name: span for name, span in sides[0].read(path).items() if not _MESSAGE.search(name)}
        known = [name for name in uses if _uses(*sides, get_package(name), is_python=False)]
        headers = [name for name in known if not _uses(*sides, name, is_python=False) and sides[0].claim(name)]
        if headers:
            names = joined_first([f"'{name}'" for name in headers], MAX_NAMES)
            text = phrase("includes added: {names}", names=names)
            if is_old:
                text = phrase("includes removed: {names}", names=names)
            yield UsageChange(text, uses[headers[0]], is_old)


def _uses(own: UsedPackages, other: UsedPackages, name: str, *, is_python: bool) -> bool:
    """Return whether the other version uses a package, header or module of a version, by its old or new name."""
    return any(other.uses(text, is_python=is_python) for text in (name, own.rename(name)))


def _format_packages(names: Phrase, *, is_python: bool, is_old: bool) -> Phrase:
    if is_python and is_old:
        return phrase("packages no longer imported: {names}", names=names)
    if is_python:
        return phrase("packages imported for the first time: {names}", names=names)
    if is_old:
        return phrase("packages no longer included: {names}", names=names)
    return phrase("packages included for the first time: {names}", names=names)


def _find_packages(path: Path, *, is_python: bool) -> set[str]:
    """Return the packages that a source seems to use, without regard to comments and disabled code."""
    text = try_read_text(path) or ""
    if is_python:
        return {module for module, _ in _find_modules(text)}
    return {get_package(match["name"]) for match in _INCLUDE.finditer(text)}


def _read_includes(source: SourceText) -> dict[str, Span]:
    text = _BLOCK_COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), source.text)
    uses: dict[str, Span] = {}
    for match in _INCLUDE.finditer(text):
        name = match["name"]
        if get_package(name) not in _SYSTEM_FOLDERS and not name.startswith("."):
            uses.setdefault(name, source.span(match.start("name"), match.end("name")))
    return uses


def _read_imports(source: SourceText) -> dict[str, Span]:
    uses: dict[str, Span] = {}
    for module, offset in _find_modules(source.text):
        if module not in _STANDARD_MODULES:
            uses.setdefault(module, source.span(offset, offset + len(module)))
    return uses


def _find_modules(text: str) -> Iterator[tuple[str, int]]:
    """Yield the first words of the imported modules, with the offset of each."""
    for match in _IMPORT.finditer(text):
        if match["source"] is not None:
            yield match["source"], match.start("source")
            continue
        for word in re.finditer(r"(?:^|,)\s*(?P<name>[A-Za-z_]\w*)", match["names"]):
            yield word["name"], match.start("names") + word.start("name")


def _is_searched(path: str) -> bool:
    return TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts)
