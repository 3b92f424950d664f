"""Find the calls of rclcpp, roscpp and tf in a C++ source that take names."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from linkwright.review.sources.cpp.text import find_arguments, find_closing_bracket
from linkwright.review.sources.names import NameKind

KINDS = {
    "create_publisher": NameKind.PUBLISHER,
    "advertise": NameKind.PUBLISHER,
    "advertiseCamera": NameKind.PUBLISHER,
    "create_camera_publisher": NameKind.PUBLISHER,
    "create_subscription": NameKind.SUBSCRIPTION,
    "subscribe": NameKind.SUBSCRIPTION,
    "subscribeCamera": NameKind.SUBSCRIPTION,
    "create_camera_subscription": NameKind.SUBSCRIPTION,
    "create_service": NameKind.SERVICE,
    "advertiseService": NameKind.SERVICE,
    "create_client": NameKind.CLIENT,
    "serviceClient": NameKind.CLIENT,
    "create_server": NameKind.ACTION,
    "declare_parameter": NameKind.PARAMETER,
    "auto_declare": NameKind.PARAMETER,
    "declare_parameter_if_not_declared": NameKind.PARAMETER,
    "get_parameter_or": NameKind.PARAMETER,
    "param": NameKind.PARAMETER,
    "getParam": NameKind.PARAMETER,
    "getParamCached": NameKind.PARAMETER,
    "lookupTransform": NameKind.FRAME_LOOKUP,
    "waitForTransform": NameKind.FRAME_LOOKUP,
    "canTransform": NameKind.FRAME_LOOKUP,
}
_WRAPPERS = {
    "swri::Subscriber": NameKind.SUBSCRIPTION,
    "swri::ServiceServer": NameKind.SERVICE,
    "swri::ServiceClient": NameKind.CLIENT,
}
"""The classes that other libraries construct with a node handle and a name."""
_CALL = re.compile(
    rf"(?P<scope>\b(?:\w+::)+|[.>]\s*(?:template\s+)?|\b)(?P<name>{'|'.join(KINDS)}|(?<=ros::param::)get|"
    rf"(?<=swri::)(?:Subscriber|ServiceServer|ServiceClient))\s*(?=[<(])"
)
ROS1_CALLS = frozenset(
    {
        *("advertise", "advertiseCamera", "advertiseService", "subscribe", "subscribeCamera", "serviceClient"),
        *("param", "getParam", "getParamCached", "get", "lookupTransform", "waitForTransform", "canTransform"),
        *("Subscriber", "ServiceServer", "ServiceClient"),
    }
)
"""The methods whose names also occur in other libraries, so that only literal names count."""
COMMUNICATION_KINDS = (NameKind.PUBLISHER, NameKind.SUBSCRIPTION, NameKind.SERVICE, NameKind.CLIENT)
GRAPH_KINDS = frozenset({*COMMUNICATION_KINDS, NameKind.ACTION, NameKind.ACTION_CLIENT})
"""The kinds of names that remappings change."""
_FREE_INDEX = {"create_publisher": 1, "create_subscription": 1, "create_service": 2, "create_client": 3}
"""The index of the name in the free functions of rclcpp, behind the interfaces of the node."""
_NODE_FIRST_CALLS = frozenset({"declare_parameter_if_not_declared"})
_NODE = re.compile(
    r"[&*]?\s*(?:this|\w*(?:nh|node|Node|handle|NodeHandle)\w*|(?:\w+\s*(?:->|\.)\s*)?(?:shared_from_this|\w*[nN]ode\w*)\s*\(\s*\))"
    r"\s*(?:\.get\s*\(\s*\))?"
)
"""An argument that is a node or its handle, before the name."""
_ONLY_NODE = re.compile(r"[&*]?\s*\w*(?:nh|[nN]ode|[hH]andle)_?")
"""An argument without a scope before its function that is a node, and no name with such a word in it."""
_OPENING = re.compile(r"\s*\(")
_OPENING_OF_MADE = re.compile(r"\s*>?\s*\(")
_MADE = r"(?:\bmake_(?:unique|shared)\s*<\s*|\bnew\s+)(?:\w+\s*::\s*)*"
_CLASS = r"(?P<class>\w*(?:Publisher|Subscri(?:ber|ption)))\s*(?=<)"
_CONSTRUCTION = re.compile(_MADE + _CLASS)
_ALIAS = re.compile(rf"\busing\s+(?P<name>\w+)\s*=\s*(?:\w+\s*::\s*)*{_CLASS}")
_CONSTRUCTED = {
    True: (NameKind.PUBLISHER, ("create_publisher", "advertise")),
    False: (NameKind.SUBSCRIPTION, ("create_subscription", "subscribe")),
}
"""The kind of name that a template makes, with the methods of ROS 2 and ROS 1 that do the same."""
_HANDLE = re.compile(r"n|\w*(?:nh|[hH]andle)\w*")
"""A node handle of ROS 1."""
_GLOBAL_SCOPES = frozenset({"ros::param::", "rclcpp::", "rclcpp_action::"})


class Call(NamedTuple):
    """A call that takes a name.

    Attributes:
        kind: the kind of the name.
        function: the name of the function.
        scope: the text before the name, such as ``ros::param::`` or a dot.
        type: the first template arguments; empty if there are none.
        arguments: the offsets of the arguments, from the name on if a node comes before it.
        node: the text of the node or handle before the name; empty if there is none.
        start: the offset of the name of the function.
        is_action: whether the name is of an action, which may follow several other arguments.
    """

    kind: NameKind
    function: str
    scope: str
    type: str
    arguments: list[tuple[int, int]]
    node: str
    start: int
    is_action: bool


def find_calls(text: str) -> Iterator[Call]:
    """Yield the calls in a C++ source without comments."""
    for match in _CALL.finditer(text):
        call = _read_call(text, match)
        if call is not None:
            yield call
    yield from _find_constructions(text)


def _find_constructions(text: str) -> Iterator[Call]:
    """Yield the constructions of templates such as ``RealtimePublisher``, from a node, a name and a message type.

    The last template argument is the type. Templates that the source defines are left out.
    """
    found = [(match, match["class"], match.end(), 0) for match in _CONSTRUCTION.finditer(text)]
    for alias in _ALIAS.finditer(text):
        made = re.compile(rf"{_MADE}{alias['name']}\b").finditer(text, alias.end())
        found += [(match, alias["class"], alias.end(), match.end()) for match in made]
    for match, name, opening, end in found:
        closing = find_closing_bracket(text, opening)
        parenthesis = _OPENING_OF_MADE.match(text, end or closing + 1)
        arguments = [] if parenthesis is None else list(find_arguments(text, parenthesis.end() - 1))
        node = text[slice(*arguments[0])].strip() if len(arguments) > 1 else ""
        is_ros1 = _HANDLE.fullmatch(node) is not None
        if (is_ros1 or _NODE.fullmatch(node)) and not re.search(rf"\b(?:class|struct)\s+{name}\b", text):
            type_name = " ".join(text[opening + 1 : closing].rpartition(",")[2].split())
            kind, functions = _CONSTRUCTED[name.endswith("Publisher")]
            yield Call(kind, functions[is_ros1], "", type_name, arguments[1:], node, match.start(), is_action=False)


def _read_call(text: str, match: re.Match[str]) -> Call | None:
    function, scope = match["name"], match["scope"].strip()
    kind = _WRAPPERS.get(f"swri::{function}") or KINDS.get(function, NameKind.PARAMETER)
    is_action = scope == "rclcpp_action::" or function == "create_server"
    if is_action and kind is NameKind.CLIENT:
        kind = NameKind.ACTION_CLIENT
    start, type_name = match.end(), ""
    if text[start] == "<":
        end = find_closing_bracket(text, start)
        type_name = " ".join(text[start + 1 : end].split())
        if function == "advertiseService":
            type_name = type_name.partition(",")[0].removesuffix("::Request")
        if kind not in GRAPH_KINDS:
            type_name = type_name.rpartition("::")[2]
        opening = _OPENING.match(text, end + 1)
        start = len(text) if opening is None else opening.end() - 1
    if text[start : start + 1] != "(":
        return None
    if function == "param" and not type_name and not scope:
        return None  # a different function with the same name
    arguments, node = list(find_arguments(text, start)), ""
    if function in _NODE_FIRST_CALLS:
        arguments = arguments[1:]
    elif scope == "rclcpp::" and function in _FREE_INDEX:
        arguments = arguments[_FREE_INDEX[function] :]
    elif (scope.endswith("::") or not scope) and scope not in _GLOBAL_SCOPES and len(arguments) > 1:
        first = text[slice(*arguments[0])].strip()
        if (_NODE if scope else _ONLY_NODE).fullmatch(first):
            arguments, node = arguments[1:], first
    return Call(kind, function, scope, type_name, arguments, node, match.start("name"), is_action)
