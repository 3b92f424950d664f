"""Find changed files whose contents mean the same: only comments, blanks or the notation of values differ."""

from __future__ import annotations

import ast
import filecmp
from collections.abc import Callable, Hashable
from pathlib import Path, PurePosixPath

import yaml

from linkwright.diagnostics import LinkwrightError
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changed_lines import split_content_lines
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.build.cmake_files import CMAKE_FILE, CMAKE_SUFFIX
from linkwright.review.files.parameters.yaml_values import compose_yaml, read_yaml_text
from linkwright.review.renames.packages import find_renamed_packages
from linkwright.review.texts.comments import XML_SUFFIXES
from linkwright.review.versions import Versions
from linkwright.xacro.cache import read_document
from linkwright.xmltree import Element

_SUFFIXES_WITH_HASHES = (CMAKE_SUFFIX, ".sh", ".bash")
"""The ends of the names of files in which comments begin with ``#``, besides those of other readers."""


def keeps_contents(versions: Versions, file: ChangedFile) -> bool:
    """Return whether both versions of a file mean the same, as far as its format is known.

    A file that moves with its package, which keeps its name, has to be the same.
    """
    if file.old_path is None or file.new_path is None or file.is_submodule or file.is_executable is not None:
        return False
    if file.new_path != file.old_path:
        packages = [item for item in find_renamed_packages(versions) if item.old_name == item.new_name]
        has_moved = any(item.new_path(file.old_path) == file.new_path for item in packages)
        paths = versions.old.file(file.old_path), versions.new.file(file.new_path)
        return has_moved and all(path.is_file() for path in paths) and filecmp.cmp(*paths, shallow=False)
    read = _find_reader(file.path)
    if read is None:
        return False
    try:
        return read(versions.old.file(file.old_path)) == read(versions.new.file(file.new_path))
    except (LinkwrightError, UnreadableFileError, OSError, SyntaxError, ValueError, RecursionError, MemoryError):
        return False


def _find_reader(path: str) -> Callable[[Path], Hashable] | None:
    """Return the function that reads the meaning of a file; None for files of other formats."""
    name = PurePosixPath(path).name
    if name.endswith(XML_SUFFIXES):
        return lambda file: _read_element(read_document(str(file)).root)
    if name.endswith((".yaml", ".yml")):
        return lambda file: _read_node(compose_yaml(read_yaml_text(file)))
    if name.endswith(".py"):
        return lambda file: ast.dump(ast.parse(file.read_bytes()))
    if name.endswith(_SUFFIXES_WITH_HASHES) or name == CMAKE_FILE:
        return lambda file: tuple(split_content_lines(file.read_text("utf-8")))
    return None


def _read_element(element: Element) -> Hashable:
    children = tuple(map(_read_element, element.elements()))
    return element.tag, frozenset(element.attributes.items()), " ".join(element.text().split()), children


def _read_node(node: yaml.Node | None) -> Hashable:
    if isinstance(node, yaml.MappingNode):
        return node.tag, tuple((_read_node(key), _read_node(value)) for key, value in node.value)
    if isinstance(node, yaml.SequenceNode):
        return node.tag, tuple(map(_read_node, node.value))
    return None if node is None else (node.tag, node.value)
