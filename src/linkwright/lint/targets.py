"""From the files and folders that the user names to the descriptions and packages to check."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.packages import enclosing_package
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.sources import IGNORE_MARKERS, SKIPPED_FOLDERS
from linkwright.xacro import sources
from linkwright.xmltree import Element

_URDF, _XACRO = ".urdf", ".xacro"
_WHOLE = (_URDF, ".world", ".sdf")
"""Endings of files that describe something by themselves."""
_EMPTY_FILE = "XML105"
_WEB_PAGE = "package.json"
"""What the folder of a program in JavaScript has."""
_OTHER_FORMATS = (".srdf.xacro", ".sdf.xacro", ".world.xacro", ".launch.xacro")
_INCLUDED = re.compile(r"""<xacro:include\b[^>]*?\bfilename\s*=\s*["']([^"']+)["']""")
_ARGUMENT = re.compile(r"<xacro:arg\b[^>]*>")
_ATTRIBUTE = re.compile(r"""\b(name|default)\s*=\s*["']([^"']+)["']""")
_GIVEN = re.compile(r"\$\(arg\s+(\S+?)\s*\)")
_OPTIONAL = re.compile(r"\$\(optenv\s+\S+\s+([^)]*)\)")
_DECLARATIONS = frozenset({"xacro:include", "xacro:macro", "xacro:property", "xacro:arg"})
_WITHOUT_LINKS = frozenset({"gazebo", "material", "ros2_control", "transmission", "webots"})
"""What a part of a robot may hold that others include under a name which no text search finds."""


@dataclass(frozen=True, slots=True)
class Targets:
    """The files and packages to be checked.

    Attributes:
        files: the descriptions, each once.
        packages: the folders of the packages to check, each once.
        named: the files that the user named, which are not found in a folder.
    """

    files: tuple[Path, ...]
    packages: tuple[Path, ...]
    named: frozenset[Path] = frozenset()


def find_targets(paths: Iterable[Path], *, around: bool = False) -> Targets:
    """The descriptions and packages that files and folders mean.

    A file is checked whatever it is; the package that it lies in is checked only if `around` says so. Of a folder and
    those below it, what is checked are the packages, that around the folder too, and, of the files that no other there
    includes, the ``.urdf``, ``.sdf`` and ``.world`` files and those ``.xacro`` files that describe a robot by
    themselves: their root is a ``<robot>`` with a name, and they hold more than declarations. Build products and hidden
    folders are left out, and so are files with nothing in them, and web pages inside a package, which read URDF in
    their own way.
    """
    files: dict[Path, None] = {}
    packages: dict[Path, None] = {}
    for path in paths:
        if path.is_dir():
            found, below = _walk(path)
            files.update(dict.fromkeys(_entries(found)))
            packages.update(dict.fromkeys(below))
        else:
            files[path] = None
    for path in paths:
        if around or path.is_dir():
            package = enclosing_package((path if path.is_dir() else path.parent).absolute())
            if package is not None:
                packages[package[1]] = None
    return Targets(tuple(files), tuple(packages), frozenset(path for path in paths if not path.is_dir()))


def _walk(folder: Path) -> tuple[list[Path], list[Path]]:
    """The description files at and below a folder and the packages there, in the order of their names."""
    found: list[Path] = []
    packages: list[Path] = []
    for place, folders, names in os.walk(folder):
        if not IGNORE_MARKERS.isdisjoint(names):
            folders.clear()
            continue
        here = Path(place).absolute()
        if _WEB_PAGE in names and MANIFEST not in names and not set(packages).isdisjoint(here.parents):
            folders.clear()
            continue
        folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in SKIPPED_FOLDERS)
        if MANIFEST in names:
            packages.append(here)
        described = [Path(place, name) for name in sorted(names) if name.endswith((*_WHOLE, _XACRO))]
        found += [path for path in described if not path.is_fifo()]
    return found, packages


def _entries(found: list[Path]) -> Iterator[Path]:
    included = {name for path in found for name in _included_names(_text(path))}
    for path in found:
        if path.name in included or (path.suffix == _URDF and _is_part(path)):
            continue
        if path.suffix in _WHOLE or _describes_robot(path):
            yield path


def _is_part(path: Path) -> bool:
    """Whether a file is called a URDF and only holds what goes with links, such as materials, plugins or macros.

    Such are the files of webots_ros2_driver, and parts of a robot that somebody expanded one by one.
    """
    try:
        root = sources.read(str(path)).root
    except LinkwrightError as error:
        return any(diagnostic.code == _EMPTY_FILE for diagnostic in error.diagnostics)
    return root.tag == "robot" and next(root.elements(), None) is not None and not _has_content(root)


def _included_names(text: str) -> Iterator[str]:
    """The names of the files that a description includes with the defaults of its arguments and of `$(optenv ...)`."""
    arguments = [dict(_ATTRIBUTE.findall(tag)) for tag in _ARGUMENT.findall(text)]
    defaults = {each["name"]: each.get("default", "") for each in arguments if "name" in each}
    for written in _INCLUDED.findall(text):
        chosen = _GIVEN.sub(lambda given: defaults.get(given[1], ""), written)
        yield Path(_OPTIONAL.sub(r"\1", chosen).strip()).name


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""  # which the check will tell


def _describes_robot(path: Path) -> bool:
    if path.name.endswith(_OTHER_FORMATS):
        return False
    try:
        root = sources.read(str(path)).root
    except LinkwrightError as error:
        # An empty file is one that its author has yet to write; anything else the check will tell.
        return all(diagnostic.code != _EMPTY_FILE for diagnostic in error.diagnostics)
    return root.tag == "robot" and "name" in root.attributes and _has_content(root)


def _has_content(root: Element) -> bool:
    """Whether there is more than declarations: a wrapper that only includes others counts as well."""
    tags = {element.tag for element in root.elements()}
    return (
        bool(tags - _DECLARATIONS - _WITHOUT_LINKS)
        or tags == {"xacro:include"}
        or tags == {"xacro:include", "xacro:arg"}
    )
