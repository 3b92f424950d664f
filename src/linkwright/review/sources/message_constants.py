"""Read the text constants of messages of the repository, with which sources name topics and frames."""

from __future__ import annotations

import ast
import os
from collections.abc import Mapping
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.packages import MANIFEST
from linkwright.packages.manifest import enclosing_package, package_name
from linkwright.review.caching import cached_in_review
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.interfaces import read_structures
from linkwright.review.sources.enclosing_folders import list_enclosing_folders

_MAX_LEVELS = 5
"""The maximum number of folders above a package in which another package of the repository is searched."""
_MAX_DEPTH = 3
"""The maximum number of folders between one of these and the other package."""
_MODULE = ".msg"


def read_imported_message_constants(path: Path, tree: ast.Module) -> dict[str, ast.expr]:
    """Return the text constants of messages that a Python source imports and uses, such as ``Topics.SCAN``.

    Args:
        path: the path of the source.
        tree: its syntax tree.
    """
    imports = [
        (alias.asname or alias.name, node.module.removesuffix(_MODULE), alias.name)
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        and node.level == 0
        and (node.module or "").endswith(_MODULE)
        and node.module is not None
        for alias in node.names
    ]
    used = {
        node.value.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.attr.isupper()
    }
    return {
        f"{local}.{name}": ast.Constant(text)
        for local, package, message in imports
        if local in used
        for name, text in read_message_constants(path, package, message).items()
    }


def read_message_constants(path: Path, package: str, message: str) -> Mapping[str, str]:
    """Return the text constants of a message of the repository; empty if the repository does not have the message.

    Args:
        path: the path of a source of the repository.
        package: the name of the package of the message.
        message: the name of the message.
    """
    own = enclosing_package(path.parent)
    package_folder = (path.parent if own is None else own[1]).resolve()
    for folder in list_enclosing_folders(package_folder, 1 + _MAX_LEVELS)[1:]:
        file = _find_message(folder, package, message)
        if file is not None:
            return _read_texts(file, file.stat().st_mtime_ns)
    return {}


def _find_message(folder: Path, package: str, message: str) -> Path | None:
    """Return the file of a message of a package below a folder, or None."""
    for candidate in _list_folders(folder, package):
        file = candidate / "msg" / f"{message}.msg"
        if file.is_file() and package_name(candidate) == package:
            return file
    return None


@cached_in_review(maxsize=256)
def _list_folders(folder: Path, name: str) -> tuple[Path, ...]:
    """Return the folders with a name below a folder that have a manifest."""
    found: list[Path] = []
    level = [folder]
    for _ in range(_MAX_DEPTH):
        found += (parent / name for parent in level if _has_manifest(parent / name))
        level = [child for parent in level for child in _list_children(parent)]
    return tuple(found)


def _list_children(folder: Path) -> list[Path]:
    """Return the folders in a folder that contain no manifest."""
    try:
        with os.scandir(folder) as entries:
            names = [entry.name for entry in entries if entry.is_dir(follow_symlinks=False)]
    except OSError:
        return []
    children = (folder / name for name in sorted(names) if not name.startswith("."))
    return [child for child in children if not _has_manifest(child)]


def _has_manifest(folder: Path) -> bool:
    try:
        return (folder / MANIFEST).is_file()
    except OSError:  # a folder that the user may not read
        return False


@cached_in_review(maxsize=64)
def _read_texts(file: Path, _modified_ns: int) -> Mapping[str, str]:
    try:
        structures = read_structures(file)
    except (LinkwrightError, UnreadableFileError, OSError, ValueError):
        return {}
    constants = (constant for structure in structures.values() for constant in structure.constants)
    return {constant.name: constant.value for constant in constants if isinstance(constant.value, str)}
