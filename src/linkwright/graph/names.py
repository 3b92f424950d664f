"""Names in the graph: which are valid, how they are expanded, how they are remapped.

The rules and the wording of the errors are those of rcl and rmw (``validate_topic_name``, ``expand_topic_name``,
``remap``).
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from linkwright.diagnostics import Diagnostic, LinkwrightError

_SUBSTITUTION = re.compile(r"\{([^{}]*)\}")
_MAX_NODE_NAME_LENGTH = 255


class InvalidNameError(LinkwrightError):
    """A node name, namespace or topic name that ROS does not allow.

    Args:
        kind: ``node name``, ``namespace`` or ``topic name``.
        name: the name as it was given.
        reason: what is wrong with it.
    """

    def __init__(self, kind: str, name: str, reason: str) -> None:
        super().__init__(Diagnostic("GRAPH101", f"'{name}' is not a valid {kind}: {reason}"))
        self.name = name


def check_node_name(name: str) -> None:
    """Raise InvalidNameError unless a node may bear the name."""
    if not name:
        reason = "node name must not be empty"
    elif re.search(r"[^A-Za-z0-9_]", name):
        reason = "node name must not contain characters other than alphanumerics or '_'"
    elif name[0].isdigit():
        reason = "node name must not start with a number"
    elif len(name) > _MAX_NODE_NAME_LENGTH:
        reason = f"node name length should not exceed '{_MAX_NODE_NAME_LENGTH}'"
    else:
        return
    raise InvalidNameError("node name", name, reason)


def absolute_namespace(namespace: str) -> str:
    """The namespace with its leading slash, which may be left out; ``/`` for an empty one.

    Raises:
        InvalidNameError: it is not valid.
    """
    absolute = namespace if namespace.startswith("/") else f"/{namespace}"
    if absolute == "/":
        return absolute
    if absolute.endswith("/"):
        reason = "namespace must not end with a '/'"
    elif re.search(r"[^A-Za-z0-9_/]", absolute):
        reason = "namespace must not contain characters other than alphanumerics, '_', or '/'"
    elif "//" in absolute:
        reason = "namespace must not contain repeated '/'"
    elif re.search(r"/\d", absolute):
        reason = "namespace must not have a token that starts with a number"
    else:
        return absolute
    raise InvalidNameError("namespace", namespace, reason)


def join(namespace: str, name: str) -> str:
    """The full name of something in a namespace."""
    return f"/{name}" if namespace == "/" else f"{namespace}/{name}"


def expand_topic_name(name: str, node_name: str, namespace: str) -> str:
    """The absolute name of a topic that a node names: relative, ``/absolute``, ``~/private``, ``{node}`` and ``{ns}``.

    Args:
        name: the name as the node's code gives it.
        node_name: the node's name without its namespace.
        namespace: the node's namespace, absolute.

    Raises:
        InvalidNameError: it is not valid.
    """
    _check_topic_name(name)
    substitutions = {"node": node_name, "ns": namespace, "namespace": namespace}

    def substitute(match: re.Match[str]) -> str:
        value = substitutions.get(match[1])
        if value is None:
            raise InvalidNameError("topic name", name, f"unknown substitution '{{{match[1]}}}'")
        return value

    expanded = _SUBSTITUTION.sub(substitute, name)
    if expanded.startswith("~"):
        expanded = join(namespace, node_name) + expanded[1:]
    elif not expanded.startswith("/"):
        expanded = join(namespace, expanded)
    if "//" in expanded:
        raise InvalidNameError("topic name", name, "topic name must not contain repeated '/'")
    return expanded


def _check_topic_name(name: str) -> None:
    bare = _SUBSTITUTION.sub("x", name)
    if not name:
        reason = "topic name must not be empty string"
    elif name.endswith("/"):
        reason = "topic name must not end with a forward slash"
    elif re.search(r"[^A-Za-z0-9_/~{}]", name):
        reason = "topic name must not contain characters other than alphanumerics, '_', '~', '{', or '}'"
    elif "{" in bare or "}" in bare:
        reason = "topic name must not have unmatched (unbalanced) curly braces '{}'"
    elif "~" in name[1:]:
        reason = "topic name must not have tilde '~' unless it is the first character"
    elif name.startswith("~") and name != "~" and name[1] != "/":
        reason = "topic name must not have a tilde '~' that is not followed by a forward slash '/'"
    elif re.search(r"(^|/)\d", bare):
        reason = "topic name token must not start with a number"
    elif "//" in name:
        reason = "topic name must not contain repeated '/'"
    else:
        return
    raise InvalidNameError("topic name", name, reason)


class Remappings:
    """A node's remapping rules, each ``from`` and ``to``; the first that fits is taken.

    ``__node`` (or ``__name``) and ``__ns`` rename the node itself.
    """

    __slots__ = ("_rules",)

    def __init__(self, rules: Sequence[tuple[str, str]] = ()) -> None:
        self._rules = tuple(rules)

    def node_name(self, name: str) -> str:
        """The name the node is to bear instead of the one its code gives."""
        return self._special(("__node", "__name")) or name

    def namespace(self, namespace: str) -> str:
        """The namespace the node is to live in instead of the one its code gives."""
        return self._special(("__ns",)) or namespace

    def topic(self, full_name: str, node_name: str, namespace: str) -> str:
        """The topic to use instead of an expanded one. Both sides of a rule are expanded as the node's own names are.

        Raises:
            InvalidNameError: a side of a rule is not a valid topic name.
        """
        for source, target in self._rules:
            if source.startswith("__"):
                continue
            if expand_topic_name(source, node_name, namespace) == full_name:
                return expand_topic_name(target, node_name, namespace)
        return full_name

    def _special(self, names: tuple[str, ...]) -> str | None:
        return next((target for source, target in self._rules if source in names), None)
