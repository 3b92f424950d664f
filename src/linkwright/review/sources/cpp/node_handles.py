"""Find the namespaces in which node handles, nodelets and sub-nodes of C++ sources use their names."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

_HANDLES = re.compile(r"\bNodeHandle\b(?P<names>[^;{}<>]*)[;{]")
_HANDLE = re.compile(r'\b(?P<name>\w+)\s*[({]\s*(?:\w+\s*,\s*)?"(?P<namespace>[^"]+)"\s*[)}]')
_INITIALIZED_HANDLE = re.compile(
    r'\bNodeHandle\s+(?P<name>\w+)\s*(?:=\s*(?:ros\s*::\s*)?NodeHandle\s*)?[({]\s*"(?P<namespace>[^"]+)"\s*[)}]'
)
_PLAIN_HANDLES = re.compile(r"\bNodeHandle\s+(\w+(?:\s*,\s*\w+)*)\s*;")
_GETTER = r"(?:this\s*->\s*)?getM?T?(?P<private>Private)?NodeHandle\s*\(\s*\)"
"""A method of a nodelet that returns a node handle."""
_ASSIGNED_HANDLE = re.compile(
    rf'\b(?P<name>\w+)\s*(?:=\s*|[({{]\s*){_GETTER}\s*(?:,\s*"(?P<namespace>[^"]*)"\s*)?[;)}}]'
)
"""A handle of a nodelet in a variable, or one below it, such as ``nh(getPrivateNodeHandle(), "left")``."""
_CREATED_HANDLE = re.compile(
    r"\b(?P<name>\w+)\s*(?:(?:\.|->)\s*reset\s*\(\s*new\s+(?:ros\s*::\s*)?NodeHandle|"
    r"=\s*(?:\w+\s*::\s*)?make_(?:unique|shared)\s*<\s*(?:ros\s*::\s*)?NodeHandle\s*>)"
    r'\s*\(\s*"(?P<namespace>[^"]+)"\s*\)'
)
_SUB_NODE = re.compile(
    r'\b(?P<name>\w+)\s*[=({]\s*(?P<parent>(?:this|\w+)\s*->\s*)?create_sub_node\s*\(\s*"(?P<namespace>[^"]+)"\s*\)'
)
_VARIABLE = re.compile(r"\b(?P<name>\w+)\s*(?:\.|->)\s*$")
_CALLED_GETTER = re.compile(rf"\b{_GETTER}\s*(?:\.|->)\s*$")
_CALLED_SUB_NODE = re.compile(r'\bcreate_sub_node\s*\(\s*"(?P<namespace>[^"]+)"\s*\)\s*->\s*$')
_MAX_RECEIVER_CHARACTERS = 80
_PRIVATE = "~"


class Handles:
    """The node handles and sub-nodes of a C++ source.

    Args:
        text: the source without comments.
        headers: the texts of the headers that may declare members of its classes.
    """

    def __init__(self, text: str, headers: Sequence[str]) -> None:
        self._text = text
        self._namespaces = _find_namespaces(text, headers)
        self._assigned = [
            (match.start(), match["name"], _join(_PRIVATE if match["private"] else "", match["namespace"] or ""))
            for match in _ASSIGNED_HANDLE.finditer(text)
        ] + [(match.start(), match["name"], match["namespace"]) for match in _CREATED_HANDLE.finditer(text)]
        self._sources = [text, *headers]
        self._sub_nodes: dict[str, str] = {}
        for match in _SUB_NODE.finditer(text):
            parent = self._sub_nodes.get((match["parent"] or "").removesuffix("->").strip(), "")
            self._sub_nodes[match["name"]] = _join(parent, match["namespace"])

    def find_handle_namespace(self, start: int) -> str:
        """Return the namespace of the node handle on which the method at an offset is called.

        It is ``~`` for a private handle, and empty for others and unknown ones.
        """
        receiver = _find_receiver(_CALLED_GETTER, self._text, start)
        if receiver is not None:
            return _PRIVATE if receiver["private"] else ""
        variable = _find_receiver(_VARIABLE, self._text, start)
        if variable is None:
            return ""
        assigned = sorted((offset, namespace) for offset, name, namespace in self._assigned if name == variable["name"])
        before = [namespace for offset, namespace in assigned if offset < start]
        if assigned:
            return before[-1] if before else assigned[0][1]
        return self._namespaces.get(variable["name"], "")

    def get_namespace(self, handle: str) -> str:
        """Return the namespace of the handle that a function is given; empty for others and unknown ones."""
        return self._namespaces.get(handle.strip("&* "), "")

    def has_known_namespace(self, start: int) -> bool:
        """Return whether the namespace of the handle on which the method at an offset is called is known.

        The namespace of a handle that a caller passes is unknown.
        """
        if _find_receiver(_CALLED_GETTER, self._text, start) is not None:
            return True
        variable = _find_receiver(_VARIABLE, self._text, start)
        if variable is None:
            return False
        name = variable["name"]
        if name in self._namespaces or any(name == assigned for _, assigned, _ in self._assigned):
            return True
        is_declared = any(name in names.split() for source in self._sources for names in _list_plain_handles(source))
        passed = re.compile(rf"\bNodeHandle\s*(?:const\s*)?[&*]\s*{name}\b|\b{name}\s*(?:[({{]\s*\w|=(?!=))")
        return is_declared and not any(passed.search(source) for source in self._sources)

    def find_sub_namespace(self, start: int) -> str:
        """Return the namespace of the rclcpp sub-node on which the method at an offset is called; empty for a node."""
        receiver = _find_receiver(_CALLED_SUB_NODE, self._text, start)
        if receiver is not None:
            return receiver["namespace"]
        variable = _find_receiver(_VARIABLE, self._text, start)
        return "" if variable is None else self._sub_nodes.get(variable["name"], "")


def _list_plain_handles(text: str) -> Iterator[str]:
    """Yield the names in each declaration of handles without a namespace, separated by spaces."""
    return (names.replace(",", " ") for names in _PLAIN_HANDLES.findall(text))


def add_namespace(namespace: str, name: str) -> str:
    """Return a name in a namespace. Global and private names have none."""
    return name if not namespace or not name or name.startswith(("/", "~")) else _join(namespace, name)


def _join(namespace: str, name: str) -> str:
    if not namespace or not name:
        return namespace or name
    return f"{namespace}{'' if namespace == _PRIVATE else '/'}{name}"


def _find_receiver(pattern: re.Pattern[str], text: str, start: int) -> re.Match[str] | None:
    return pattern.search(text, max(0, start - _MAX_RECEIVER_CHARACTERS), start)


def _find_namespaces(text: str, headers: Sequence[str]) -> Mapping[str, str]:
    """Return the namespaces of ROS 1 node handles, by variable.

    Args:
        text: the source without comments.
        headers: the texts of the headers that may declare members of its classes.
    """
    own, declared = (
        {name for source in sources for names in _PLAIN_HANDLES.findall(source) for name in re.findall(r"\w+", names)}
        for sources in ([text], headers)
    )
    namespaces = {
        match["name"]: match["namespace"]
        for source in (*headers, text)
        for match in _INITIALIZED_HANDLE.finditer(source)
        if source is text or match["name"] not in own
    }
    for handles in _HANDLES.finditer(text):
        namespaces |= {match["name"]: match["namespace"] for match in _HANDLE.finditer(handles["names"])}
    for source in (*headers, text):
        members = own | declared if source is text else declared - own
        matches = (match for match in _HANDLE.finditer(source) if match["name"] in members)
        namespaces |= {match["name"]: match["namespace"] for match in matches}
    return {name: namespace.rstrip("/") for name, namespace in namespaces.items()}
