"""The literal names in the sources of nodes: topics, services, actions, parameters and nodes, read without running."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path

from linkwright.diagnostics import Phrase, SourceText, Span, phrase
from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name

_MAX_BYTES = 1 << 20
CPP_SUFFIXES = (".cpp", ".cc", ".cxx", ".hpp", ".hh", ".hxx", ".h")
PYTHON_SUFFIX = ".py"


class NameKind(Enum):
    """The kind of a name: what a report calls one of them, and several of them."""

    PUBLISHER = (phrase("publisher"), phrase("publishers"))
    SUBSCRIPTION = (phrase("subscription"), phrase("subscriptions"))
    SERVICE = (phrase("service"), phrase("services"))
    CLIENT = (phrase("service client"), phrase("service clients"))
    ACTION = (phrase("action"), phrase("actions"))
    ACTION_CLIENT = (phrase("action client"), phrase("action clients"))
    PARAMETER = (phrase("parameter"), phrase("parameters"))
    NODE = (phrase("node"), phrase("nodes"))

    def __init__(self, title: Phrase, plural: Phrase) -> None:
        self.title = title
        self.plural = plural


@dataclass(frozen=True)
class SourceName:
    """A literal name in a source.

    Attributes:
        kind: the kind.
        name: the name as it is written.
        type: the type of the messages, or the default of a parameter; empty if it is not literal.
        span: the location.
    """

    kind: NameKind
    name: str
    type: str
    span: Span


@dataclass
class SourceNames:
    """The names in a source.

    Attributes:
        names: the literal names.
        expressions: how many names of a kind are expressions, whose values are not known.
    """

    names: list[SourceName] = field(default_factory=list)
    expressions: Counter[NameKind] = field(default_factory=Counter)


def read_source_names(path: Path) -> SourceNames:
    """Return the names in a source in Python or C++; those of a file that cannot be read are empty."""
    names = SourceNames()
    try:
        if path.stat().st_size > _MAX_BYTES:
            return names
        source = SourceText(str(path), path.read_text("utf-8", errors="replace"))
        if path.suffix == PYTHON_SUFFIX:
            _read_python(PythonFile(source), names)
        else:
            _read_cpp(source, names)
    except (OSError, ValueError, SyntaxError, RecursionError):
        return SourceNames()
    return names


# --- Python -----------------------------------------------------------------------------------------------------------

_RCLPY = {
    "create_publisher": (NameKind.PUBLISHER, "msg_type", "topic"),
    "create_subscription": (NameKind.SUBSCRIPTION, "msg_type", "topic"),
    "create_service": (NameKind.SERVICE, "srv_type", "srv_name"),
    "create_client": (NameKind.CLIENT, "srv_type", "srv_name"),
}
"""The methods of nodes with the parameters of the type and of the name, which are the first two."""
_NAME_FIRST = {
    "Publisher": NameKind.PUBLISHER,
    "Subscriber": NameKind.SUBSCRIPTION,
    "Service": NameKind.SERVICE,
    "ServiceProxy": NameKind.CLIENT,
    "SimpleActionServer": NameKind.ACTION,
    "SimpleActionClient": NameKind.ACTION_CLIENT,
}
"""The classes of ROS 1 whose first two arguments are the name and the type."""
_RCLPY_ACTIONS = {"ActionServer": NameKind.ACTION, "ActionClient": NameKind.ACTION_CLIENT}
"""The classes whose second and third arguments are the type and the name."""
_NODES = ("init_node", "create_node", "Node", "LifecycleNode")


def _read_python(python: PythonFile, names: SourceNames) -> None:
    calls = [node for node in ast.walk(python.tree) if isinstance(node, ast.Call)]
    for call in sorted(calls, key=lambda node: (node.lineno, node.col_offset)):
        function = called_name(call).rpartition(".")[2]
        if isinstance(call.func, ast.Attribute) and function == "":
            function = call.func.attr
        _read_call(python, names, call, function)


def _read_call(python: PythonFile, names: SourceNames, call: ast.Call, function: str) -> None:
    def argument(index: int, keyword: str = "") -> ast.expr | None:
        return call.args[index] if index < len(call.args) else argument_of(call, keyword)

    if function in _RCLPY:
        kind, type_keyword, name_keyword = _RCLPY[function]
        _add(python, names, kind, argument(1, name_keyword), argument(0, type_keyword))
    elif function in _RCLPY_ACTIONS:
        _add(python, names, _RCLPY_ACTIONS[function], argument(2, "action_name"), argument(1, "action_type"))
    elif function in _NAME_FIRST and call.args and python.text(call.args[0]) is not None:
        _add(python, names, _NAME_FIRST[function], call.args[0], argument(1))
    elif function == "declare_parameter":
        _add(python, names, NameKind.PARAMETER, argument(0, "name"), argument(1, "value"))
    elif function == "declare_parameters":
        _read_parameters(python, names, argument(0, "namespace"), argument(1, "parameters"))
    elif (function in _NODES and python.text(argument(0, "node_name")) is not None) or (
        function == "__init__" and _is_node(python, call)
    ):
        _add(python, names, NameKind.NODE, argument(0, "node_name"), None)


def _read_parameters(
    python: PythonFile, names: SourceNames, namespace: ast.expr | None, parameters: ast.expr | None
) -> None:
    items = None if parameters is None else python.resolved(parameters)
    prefix = python.text(namespace)
    if not isinstance(items, (ast.List, ast.Tuple)) or prefix is None:
        names.expressions[NameKind.PARAMETER] += 1
        return
    for item in items.elts:
        pair = python.resolved(item)
        if isinstance(pair, (ast.Tuple, ast.List)) and pair.elts:
            value = pair.elts[1] if len(pair.elts) > 1 else None
            _add(python, names, NameKind.PARAMETER, pair.elts[0], value, f"{prefix}." if prefix else "")
        else:
            names.expressions[NameKind.PARAMETER] += 1


def _is_node(python: PythonFile, call: ast.Call) -> bool:
    """Return whether a call of ``__init__`` is in a class that is derived from a node."""
    classes = (node for node in ast.walk(python.tree) if isinstance(node, ast.ClassDef))
    around = [node for node in classes if node.lineno <= call.lineno <= (node.end_lineno or node.lineno)]
    return bool(around) and any(ast.unparse(base).endswith("Node") for base in around[-1].bases)


def _add(
    python: PythonFile,
    names: SourceNames,
    kind: NameKind,
    node: ast.expr | None,
    type_node: ast.expr | None,
    prefix: str = "",
) -> None:
    text = python.text(node)
    if node is None or text is None:
        names.expressions[kind] += 1
        return
    if kind is NameKind.PARAMETER:
        value = None if type_node is None else python.resolved(type_node)
        type_name = ast.unparse(value) if isinstance(value, (ast.Constant, ast.List, ast.UnaryOp)) else ""
    else:
        type_name = "" if type_node is None else ast.unparse(type_node).rpartition(".")[2]
    names.names.append(SourceName(kind, prefix + text, type_name, python.span(node)))


# --- C++ --------------------------------------------------------------------------------------------------------------

_COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
_CALL = re.compile(
    r"(?P<scope>\brclcpp_action::|[.>]\s*|\b)(?P<name>create_publisher|create_subscription|create_service|"
    r"create_client|create_server|declare_parameter|advertise|advertiseService|subscribe|serviceClient)\s*(?=[<(])"
)
_NODE = re.compile(
    r"(?::\s*|,\s*)(?:rclcpp(?:_lifecycle)?::)?(?:Lifecycle)?Node\s*\(|"
    r"\brclcpp(?:_lifecycle)?::(?:Lifecycle)?Node::make_shared\s*\(|"
    r"\bmake_shared<\s*rclcpp(?:_lifecycle)?::(?:Lifecycle)?Node\s*>\s*\("
)
_CPP_KINDS = {
    "create_publisher": NameKind.PUBLISHER,
    "advertise": NameKind.PUBLISHER,
    "create_subscription": NameKind.SUBSCRIPTION,
    "subscribe": NameKind.SUBSCRIPTION,
    "create_service": NameKind.SERVICE,
    "advertiseService": NameKind.SERVICE,
    "create_client": NameKind.CLIENT,
    "serviceClient": NameKind.CLIENT,
    "create_server": NameKind.ACTION,
    "declare_parameter": NameKind.PARAMETER,
}
_ROS1 = frozenset({"advertise", "advertiseService", "subscribe", "serviceClient"})
"""The methods whose names other libraries have, too, so that only literal names count."""
_TEXT = re.compile(r'\s*(?:std::string\s*\(\s*)?"(?P<text>[^"\\]*)"\s*\)?\s*')
_LITERAL = re.compile(r'\s*(-?[\d.]+f?|true|false|"[^"\\]*")\s*')
_BRACKETS = {"(": ")", "<": ">", "[": "]", "{": "}"}


def _read_cpp(source: SourceText, names: SourceNames) -> None:
    text = _COMMENT_OR_TEXT.sub(_without_comment, source.text)
    for match in _CALL.finditer(text):
        _read_cpp_call(source, text, match, names)
    for match in _NODE.finditer(text):
        arguments = _arguments(text, match.end() - 1)
        name = None if not arguments else _TEXT.fullmatch(text[slice(*arguments[0])])
        if name is not None:
            start = arguments[0][0] + name.start("text")
            span = source.span(start, start + len(name["text"]))
            names.names.append(SourceName(NameKind.NODE, name["text"], "", span))


def _without_comment(match: re.Match[str]) -> str:
    """Return a text as it is, and spaces for a comment."""
    return match[0] if match[0].startswith('"') else re.sub(r"[^\n]", " ", match[0])


def _read_cpp_call(source: SourceText, text: str, match: re.Match[str], names: SourceNames) -> None:
    function, kind = match["name"], _CPP_KINDS[match["name"]]
    is_action = match["scope"].startswith("rclcpp_action") or function == "create_server"
    if is_action and kind is NameKind.CLIENT:
        kind = NameKind.ACTION_CLIENT
    start, type_name = match.end(), ""
    if text[start] == "<":
        end = _end_of(text, start)
        type_name = " ".join(text[start + 1 : end].split()).rpartition("::")[2]
        start = text.find("(", end, end + 20)
    if start < 0 or text[start : start + 1] != "(":
        return
    arguments = _arguments(text, start)
    candidates = arguments if is_action else arguments[:1]
    found = [(begin, literal) for begin, end in candidates if (literal := _TEXT.fullmatch(text[begin:end]))]
    if not found:
        if function not in _ROS1 and arguments:
            names.expressions[kind] += 1
        return
    begin, literal = found[0]
    if kind is NameKind.PARAMETER:
        value = _LITERAL.fullmatch(text[slice(*arguments[1])]) if len(arguments) > 1 else None
        type_name = value[1] if value else ""
    begin += literal.start("text")
    names.names.append(SourceName(kind, literal["text"], type_name, source.span(begin, begin + len(literal["text"]))))


def _end_of(text: str, start: int) -> int:
    """Return the offset of the bracket that closes the one at an offset, or the end of the text."""
    depth, opening = 0, text[start]
    for index in range(start, len(text)):
        depth += (text[index] == opening) - (text[index] == _BRACKETS[opening])
        if depth == 0:
            return index
    return len(text)


def _arguments(text: str, start: int) -> Sequence[tuple[int, int]]:
    """Return the offsets of the arguments in the parentheses that begin at an offset."""
    return list(_split(text, start + 1))


def _split(text: str, start: int) -> Iterator[tuple[int, int]]:
    depth, begin, is_text = 0, start, False
    for index in range(start, len(text)):
        character = text[index]
        if character == '"' and text[index - 1] != "\\":
            is_text = not is_text
        if is_text:
            continue
        if depth == 0 and character in ",)":
            if text[begin:index].strip():
                yield begin, index
            if character == ")":
                return
            begin = index + 1
        depth += (character in "([{") - (character in ")]}")
