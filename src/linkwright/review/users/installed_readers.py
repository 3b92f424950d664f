"""Find the paths below share folders, and the headers, that the text of a file names."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from contextlib import suppress
from typing import NamedTuple

from linkwright.diagnostics import SourceText, Span
from linkwright.packages.readers.python_values import PythonFile, SharePath, called_name, join_path
from linkwright.review.texts.comments import CPP_SUFFIXES, XML_SUFFIXES, without_comments

_OTHER_SUFFIXES = (".yaml", ".yml", ".rviz", ".sh", ".bash", ".service", ".cmake", "CMakeLists.txt")
READER_SUFFIXES = (".py", *CPP_SUFFIXES, *XML_SUFFIXES, *_OTHER_SUFFIXES)
"""The ends of the names of files that may read installed files."""
_PATH = r"(?P<path>[\w./+-]*)(?P<rest>.?)"
_SUBSTITUTIONS = tuple(
    re.compile(pattern, re.MULTILINE)
    for pattern in (
        rf"\$\(find(?:-pkg-share)?\s+(?P<package>[\w.-]+)\s*\)/{_PATH}",
        rf"\bpackage://(?P<package>[\w.-]+)/{_PATH}",
        rf"\$\(ros2 pkg prefix --share (?P<package>[\w.-]+)\)/{_PATH}",
        rf"\$\(ros2 pkg prefix (?P<package>[\w.-]+)\)/share/(?P=package)/{_PATH}",
    )
)
_CMAKE_FOLDER = re.compile(rf"\$\{{(?P<package>\w+)_DIR\}}/{_PATH}", re.MULTILINE)
_SHARE_CALL = r"\b(?:[\w:]+::)?(?:get_package_share_directory|getPath)\s*\(\s*\"(?P<package>[\w.-]+)\"\s*\)"
_CPP_PATH = re.compile(rf"{_SHARE_CALL}\s*[+/]\s*\"/?(?P<path>[^\"\n]*)\"(?P<rest>\s*[+/])?")
_CPP_VARIABLE = re.compile(rf"\b(?P<name>\w+)\s*(?:=|\(|\{{)\s*{_SHARE_CALL}\s*[;)}}]")
_CPP_VARIABLE_PATH = r"\b{name}\s*[+/]\s*\"/?(?P<path>[^\"\n]*)\"(?P<rest>\s*[+/])?"
_INCLUDE = re.compile(r"^[ \t]*#[ \t]*include[ \t]*[<\"](?P<path>[\w./+-]+)[>\"]", re.MULTILINE)
_OPEN_ENDS = ("$", "{", "%", "*")
"""The characters that begin a part of a path that is not known."""
_JOIN_NAMES = frozenset({"join", "Path", "PurePath", "joinpath", "PathJoinSubstitution"})


class NamedPath(NamedTuple):
    """A path that a file names.

    Attributes:
        package: the package whose share folder contains the path; empty for a header.
        path: the path below the share folder, or as in ``#include``.
        span: the location in the file.
        is_complete: whether the path is known to its end; otherwise it is the known folder.
    """

    package: str
    path: str
    span: Span
    is_complete: bool = True


def find_named_paths(source: SourceText, path: str) -> Iterator[NamedPath]:
    """Yield the paths below share folders that a file names, and the headers that it includes.

    Args:
        source: the text of the file.
        path: the path of the file, whose suffix is the kind of the file.
    """
    if path.endswith(".py"):
        yield from _find_python_paths(source)
        return
    text = without_comments(source.text, path)
    patterns = _SUBSTITUTIONS
    if path.endswith(CPP_SUFFIXES):
        for match in _INCLUDE.finditer(text):
            yield NamedPath("", match["path"], source.span(match.start("path"), match.end("path")))
        yield from _find_cpp_paths(source, text)
        patterns = _SUBSTITUTIONS[1:2]  # the others are notations of launch files and shells
    for pattern in patterns:
        yield from (_make_named_path(source, match, match["package"]) for match in pattern.finditer(text))
    if path.endswith((".cmake", "CMakeLists.txt")):
        for match in _CMAKE_FOLDER.finditer(text):
            yield _make_named_path(source, match, match["package"], "cmake/")


def _make_named_path(source: SourceText, match: re.Match[str], package: str, folder: str = "") -> NamedPath:
    path, rest = f"{folder}{match['path']}", match["rest"] or ""
    is_complete = rest.strip() not in (*_OPEN_ENDS, "+", "/")
    if not is_complete:
        path = path.rpartition("/")[0]
    return NamedPath(package, path.strip("/"), source.span(match.start(), match.end("path")), is_complete)


def _find_cpp_paths(source: SourceText, text: str) -> Iterator[NamedPath]:
    for match in _CPP_PATH.finditer(text):
        yield _make_named_path(source, match, match["package"])
    for variable in _CPP_VARIABLE.finditer(text):
        for match in re.finditer(_CPP_VARIABLE_PATH.format(name=variable["name"]), text[variable.end() :]):
            start = variable.end()
            path = _make_named_path(source, match, variable["package"])
            yield path._replace(span=source.span(start + match.start(), start + match.end("path")))


def _find_python_paths(source: SourceText) -> Iterator[NamedPath]:
    with suppress(SyntaxError, ValueError, RecursionError):  # paths of a file that Python cannot read are unknown
        python = PythonFile(source)
        pending: list[ast.AST] = [python.tree]
        while pending:
            node = pending.pop()
            named_path = _read_python_path(python, node) if isinstance(node, ast.expr) else None
            if named_path is not None:
                yield named_path
            else:
                pending.extend(reversed(list(ast.iter_child_nodes(node))))


def _read_python_path(python: PythonFile, node: ast.expr) -> NamedPath | None:
    """Return the path that an expression evaluates to, or its known folder; None for other expressions."""
    if isinstance(node, ast.Constant):
        return _read_python_text(python, node)
    if not isinstance(node, (ast.Call, ast.BinOp, ast.JoinedStr)):
        return None
    value = python.value(node)
    if isinstance(value, SharePath):
        return NamedPath(value.package, value.subpath.strip("/"), python.span(node)) if value.subpath else None
    parts = _split_join(node)
    known: SharePath | None = None
    for count in range(1, len(parts)):
        value = join_path([python.value(part) for part in parts[:count]])
        known = value if isinstance(value, SharePath) else known
    if known is None or not known.subpath:
        return None
    return NamedPath(known.package, known.subpath.strip("/"), python.span(node), is_complete=False)


def _read_python_text(python: PythonFile, node: ast.Constant) -> NamedPath | None:
    """Return the path in a text such as ``package://arm/meshes/base.stl``."""
    match = _SUBSTITUTIONS[1].match(node.value) if isinstance(node.value, str) else None
    if match is None:
        return None
    return _make_named_path(python.source, match, match["package"])._replace(span=python.span(node))


def _split_join(node: ast.expr) -> list[ast.expr]:
    """Return the operands of an expression that joins paths; empty for other expressions."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div):
        return [*(_split_join(node.left) or [node.left]), node.right]
    if not isinstance(node, ast.Call):
        return []
    name = called_name(node).rpartition(".")[2]
    if name not in _JOIN_NAMES:
        return []
    if name == "PathJoinSubstitution":
        items = node.args[0] if node.args else None
        return items.elts if isinstance(items, (ast.List, ast.Tuple)) else []
    owner = [node.func.value] if name == "joinpath" and isinstance(node.func, ast.Attribute) else []
    return [*owner, *node.args]
