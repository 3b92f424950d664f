"""Outlines of launch files, which are read but not run: arguments, nodes and included files with their settings."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from linkwright.diagnostics import SourceText, Span, foreign, phrase
from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name
from linkwright.review.file_pair import UnreadableFileError
from linkwright.xacro.cache import read_document
from linkwright.xmltree import Element

_NODES = ("Node", "LifecycleNode", "ComposableNode", "ComposableNodeContainer")
_NODE_TAGS = ("node", "lifecycle_node", "composable_node", "node_container")
_MAX_DEPTH = 20
_MAX_TEXT = 300
"""The number of characters of a setting that are compared and shown as text."""


@dataclass(frozen=True)
class Entry:
    """An argument, node, process or included file of a launch file.

    Attributes:
        kind: ``argument``, ``node``, ``process`` or ``include``.
        name: the name of the argument, ``package/executable`` of the node, the command or the path of the file.
        settings: the values, by name. The value of an argument is its default.
        span: where it is.
    """

    kind: str
    name: str
    settings: dict[str, str]
    span: Span


@dataclass(frozen=True)
class LaunchOutline:
    """The outline of a launch file.

    Attributes:
        entries: the entries in the order of the text.
        code: the syntax tree of a file in Python as text, without comments and layout; empty for XML.
    """

    entries: list[Entry]
    code: str = ""


def read_outline(path: Path) -> LaunchOutline:
    """Return the outline of a launch file in Python or XML.

    Raises:
        LinkwrightError: the file is not XML.
        UnreadableFileError: the file is not Python.
        OSError: the file cannot be read.
        ValueError: the file is not text in UTF-8.
    """
    if path.suffix != ".py":
        return LaunchOutline(list(_markup_entries(read_document(str(path)).root)))
    try:
        python = PythonFile(SourceText(str(path), path.read_text("utf-8")))
    except SyntaxError as error:
        line, reason = error.lineno or 1, foreign(error.msg)
        message = phrase("line {line} is not valid Python: {reason}", line=line, reason=reason)
        raise UnreadableFileError(message) from None
    return LaunchOutline(list(_python_entries(python)), ast.dump(python.tree))


# --- Python ----------------------------------------------------------------------------------------------------


def _python_entries(python: PythonFile) -> Iterator[Entry]:
    text = partial(_text, python)
    names = ("DeclareLaunchArgument", *_NODES, "ExecuteProcess", "IncludeLaunchDescription")
    for call in python.calls(*names):
        function = called_name(call).rpartition(".")[2]
        keywords = {keyword.arg: keyword.value for keyword in call.keywords if keyword.arg is not None}
        if function == "DeclareLaunchArgument":
            name = text(call.args[0] if call.args else argument_of(call, "name"))
            settings = {"default": text(keywords["default_value"])} if "default_value" in keywords else {}
            yield Entry("argument", name, settings, python.span(call))
        elif function in _NODES:
            name = "/".join(text(keywords[key]) for key in ("package", "executable", "plugin") if key in keywords)
            settings = {key: text(value) for key, value in keywords.items() if key not in _IDENTITY}
            yield Entry("node", name or text(call.func), settings, python.span(call))
        elif function == "ExecuteProcess":
            yield Entry("process", text(keywords.get("cmd")), {}, python.span(call))
        else:
            name = text(call.args[0] if call.args else argument_of(call, "launch_description_source"))
            yield Entry("include", name, _include_settings(python, keywords.get("launch_arguments")), python.span(call))


_IDENTITY = frozenset({"package", "executable", "plugin", "output", "emulate_tty", "condition"})
"""The arguments of a node that name it, and those that do not change what other programs see.

Conditions are the same text in most versions, and arguments show what they depend on.
"""


def _include_settings(python: PythonFile, node: ast.expr | None) -> dict[str, str]:
    """Return the arguments of an include: ``{...}.items()``, a dictionary or a list of pairs."""
    if node is None:
        return {}
    node = python.resolved(node)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "items":
        node = python.resolved(node.func.value)
    if isinstance(node, ast.Dict):
        pairs = zip(node.keys, node.values, strict=True)
        return {_text(python, key): _text(python, value) for key, value in pairs if key is not None}
    return {"launch_arguments": _text(python, node)}


def _text(python: PythonFile, node: ast.expr | None, depth: int = 0) -> str:
    """Return an expression in the notation of XML launch files, as far as it has one."""
    if node is None or depth > _MAX_DEPTH:
        return ""
    node = python.resolved(node)
    part = partial(_text, python, depth=depth + 1)
    if isinstance(node, ast.Constant):
        return str(node.value)
    if isinstance(node, (ast.List, ast.Tuple)):
        return f"[{', '.join(map(part, node.elts))}]"
    if isinstance(node, ast.Dict):
        pairs = zip(node.keys, node.values, strict=True)
        return f"{{{', '.join(f'{part(key)}: {part(value)}' for key, value in pairs)}}}"
    if isinstance(node, ast.Call):
        substitution = _substitution(node, part)
        if substitution is not None:
            return substitution
    return " ".join(ast.unparse(node).split())[:_MAX_TEXT]


def _substitution(node: ast.Call, part: partial[str]) -> str | None:
    """Return a substitution in the notation of XML launch files, or None for any other call."""
    function = called_name(node).rpartition(".")[2]
    first = node.args[0] if node.args else (node.keywords[0].value if node.keywords else None)
    if function == "LaunchConfiguration":
        return f"$(var {part(first)})"
    if function in ("FindPackageShare", "get_package_share_directory", "get_package_share_path"):
        return f"$(find-pkg-share {part(first)})"
    if function in ("PathJoinSubstitution", "join") and first is not None:
        pieces = first.elts if isinstance(first, (ast.List, ast.Tuple)) else node.args
        return "/".join(map(part, pieces))
    if function in ("TextSubstitution", "str", "ParameterValue", "Path") and first is not None:
        return part(first)
    if function.endswith("LaunchDescriptionSource") and first is not None:
        pieces = first.elts if isinstance(first, ast.List) else [first]
        return "".join(map(part, pieces))
    return None


# --- XML ----------------------------------------------------------------------------------------------------


def _markup_entries(element: Element) -> Iterator[Entry]:
    for child in element.elements():
        span = child.span()
        if span is None:
            continue
        attributes = child.attributes
        if child.tag == "arg":
            settings = {"default": attributes["default"]} if "default" in attributes else {}
            yield Entry("argument", attributes.get("name", ""), settings, span)
        elif child.tag in _NODE_TAGS:
            yield _markup_node(child, span)
        elif child.tag == "executable":
            yield Entry("process", attributes.get("cmd", ""), {}, span)
        elif child.tag == "include":
            settings = {item.attributes.get("name", ""): item.attributes.get("value", "") for item in _named(child)}
            yield Entry("include", attributes.get("file", ""), settings, span)
        if child.tag != "include":
            yield from _markup_entries(child)


def _named(element: Element) -> Iterator[Element]:
    """Yield the arguments that an include passes."""
    return (child for child in element.elements() if child.tag in ("arg", "let"))


def _markup_node(element: Element, span: Span) -> Entry:
    attributes = element.attributes
    name = "/".join(attributes[key] for key in ("pkg", "exec", "plugin") if key in attributes)
    ignored = {"pkg", "exec", "plugin", "output", "emulate_tty", "if", "unless"}
    settings = {key: value for key, value in attributes.items() if key not in ignored}
    for child in element.elements():
        if child.tag == "param":
            key = child.attributes.get("from") or child.attributes.get("name", "")
            settings[f"parameter {key}"] = child.attributes.get("value", "")
        elif child.tag == "remap":
            settings[f"remapping {child.attributes.get('from', '')}"] = child.attributes.get("to", "")
    return Entry("node", name, settings, span)
