"""The rules for names in the graph: validation, expansion and remapping.

The rules and the wording of the errors are those of rcl and rmw (``validate_topic_name``, ``expand_topic_name``).
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase, term

_SUBSTITUTION = re.compile(r"\{([^{}]*)\}")
_MAX_NODE_NAME_LENGTH = 255
_MAX_NAMESPACE_LENGTH = 245

Problem = tuple[str, int]
"""A mistake in a name, and the index of the character where it is."""


class InvalidNameError(LinkwrightError, ValueError):
    """Raised when ROS does not allow a name (rclpy ``NameValidationException``).

    The name may be a node name, a namespace, a topic name or a service name.

    Args:
        kind: ``node name``, ``namespace``, ``topic name`` or ``service name``.
        name: the name as it was given.
        error_msg: the mistake in the name.
        invalid_index: the index of the invalid character.

    Attributes:
        name: the name as it was given.
        error_msg: the mistake in the name.
        invalid_index: the index of the invalid character.
    """

    def __init__(self, kind: str, name: str, error_msg: str, invalid_index: int = 0) -> None:
        super().__init__(
            Diagnostic(
                "GRAPH101",
                phrase("'{name}' is not a valid {kind}: {error_msg}", name=name, kind=term(kind), error_msg=error_msg),
            )
        )
        self.kind = kind
        self.name = name
        self.error_msg = error_msg
        self.invalid_index = invalid_index


class InvalidNodeNameError(InvalidNameError):
    """Raised when a node name is not valid."""

    def __init__(self, name: str, error_msg: str, invalid_index: int = 0) -> None:
        super().__init__(phrase("node name"), name, error_msg, invalid_index)


class InvalidNamespaceError(InvalidNameError):
    """Raised when a namespace is not valid."""

    def __init__(self, name: str, error_msg: str, invalid_index: int = 0) -> None:
        super().__init__("namespace", name, error_msg, invalid_index)


class InvalidTopicNameError(InvalidNameError):
    """Raised when a topic name is not valid."""

    def __init__(self, name: str, error_msg: str, invalid_index: int = 0) -> None:
        super().__init__(phrase("topic name"), name, error_msg, invalid_index)


class InvalidServiceNameError(InvalidNameError):
    """Raised when the name of a service or an action is not valid."""

    def __init__(self, name: str, error_msg: str, invalid_index: int = 0) -> None:
        super().__init__(phrase("service name"), name, error_msg, invalid_index)


def find_node_name_problem(name: str) -> Problem | None:
    """Return the reason why a node name is not valid, and the index of the mistake.

    Return None if the name is valid.
    """
    if not name:
        return phrase("node name must not be empty"), 0
    if invalid_character := re.search(r"[^A-Za-z0-9_]", name):
        return phrase(
            "node name must not contain characters other than alphanumerics or '_'"
        ), invalid_character.start()
    if name[0].isdigit():
        return phrase("node name must not start with a number"), 0
    if len(name) > _MAX_NODE_NAME_LENGTH:
        return phrase(
            "node name length should not exceed '{max_node_name_length}'", max_node_name_length=_MAX_NODE_NAME_LENGTH
        ), _MAX_NODE_NAME_LENGTH
    return None


def check_node_name(name: str) -> None:
    """Raise InvalidNodeNameError if a node name is not valid."""
    problem = find_node_name_problem(name)
    if problem is not None:
        raise InvalidNodeNameError(name, *problem)


def find_namespace_problem(namespace: str) -> Problem | None:
    """Return the reason why an absolute namespace is not valid, and the index of the mistake.

    Returns None if the namespace is valid.
    """
    if not namespace:
        return phrase("namespace must not be empty"), 0
    if not namespace.startswith("/"):
        return phrase("namespace must be absolute, it must lead with a '/'"), 0
    if namespace == "/":
        return None
    if namespace.endswith("/"):
        return phrase("namespace must not end with a '/'"), len(namespace) - 1
    if invalid_character := re.search(r"[^A-Za-z0-9_/]", namespace):
        return phrase(
            "namespace must not contain characters other than alphanumerics, '_', or '/'"
        ), invalid_character.start()
    if (index := namespace.find("//")) >= 0:
        return phrase("namespace must not contain repeated '/'"), index + 1
    if digit := re.search(r"/\d", namespace):
        return phrase("namespace must not have a token that starts with a number"), digit.start() + 1
    if len(namespace) > _MAX_NAMESPACE_LENGTH:
        return phrase(
            "namespace should not exceed '{max_namespace_length}'", max_namespace_length=_MAX_NAMESPACE_LENGTH
        ), _MAX_NAMESPACE_LENGTH
    return None


def absolute_namespace(namespace: str) -> str:
    """Return the absolute form of a namespace.

    A missing leading slash is added, and an empty namespace becomes ``/``.

    Raises:
        InvalidNamespaceError: the namespace is not valid.
    """
    absolute = namespace if namespace.startswith("/") else f"/{namespace}"
    problem = find_namespace_problem(absolute)
    if problem is not None:
        raise InvalidNamespaceError(namespace, *problem)
    return absolute


def join(namespace: str, name: str) -> str:
    """Join a namespace and a name into a full name."""
    return f"/{name}" if namespace == "/" else f"{namespace}/{name}"


def split(full_name: str) -> tuple[str, str]:
    """Split a full name into its absolute namespace and its name."""
    namespace, _, name = full_name.rpartition("/")
    return namespace or "/", name


def is_hidden(name: str) -> bool:
    """Return whether a name is hidden by default.

    A name is hidden if one of its parts starts with ``_``.
    """
    return any(token.startswith("_") for token in name.split("/"))


@lru_cache(maxsize=4096)
def find_topic_name_problem(name: str) -> Problem | None:
    """Return why a topic or service name is not valid before expansion, or None if it is valid.

    The result is a pair: the reason, and the index of the invalid character.
    """
    plain_name = _SUBSTITUTION.sub(lambda match: "x" * len(match[0]), name) if "{" in name else name
    if not name:
        return phrase("topic name must not be empty string"), 0
    if name.endswith("/"):
        return phrase("topic name must not end with a forward slash"), len(name) - 1
    if invalid_character := re.search(r"[^A-Za-z0-9_/~{}]", name):
        return phrase(
            "topic name must not contain characters other than alphanumerics, '_', '~', '{', or '}'"
        ), invalid_character.start()
    if invalid_character := re.search(r"[{}]", plain_name):
        return phrase("topic name must not have unmatched (unbalanced) curly braces '{}'"), invalid_character.start()
    if "~" in name[1:]:
        return phrase("topic name must not have tilde '~' unless it is the first character"), name.index("~", 1)
    if name.startswith("~") and name != "~" and name[1] != "/":
        return phrase("topic name must not have a tilde '~' that is not followed by a forward slash '/'"), 1
    if invalid_character := re.search(r"\{[^{}]*[^A-Za-z0-9_{}][^{}]*\}", name):
        return (
            phrase("substitution name must not contain characters other than alphanumerics or '_'"),
            invalid_character.start(),
        )
    if invalid_character := re.search(r"(^|/)\d", plain_name):
        return phrase("topic name token must not start with a number"), invalid_character.end() - 1
    if (index := name.find("//")) >= 0:
        return phrase("topic name must not contain repeated '/'"), index + 1
    return None


def expand_topic_name(name: str, node_name: str, namespace: str) -> str:
    """Return the absolute name of a topic, expanded for a node.

    The name may be relative, ``/absolute`` or ``~/private``, and may contain ``{node}`` and ``{ns}``.

    Args:
        name: the name as written in the node's code.
        node_name: the node's name without its namespace.
        namespace: the node's namespace, absolute.

    Raises:
        InvalidTopicNameError: the name is not valid.
    """
    return _expand(name, node_name, namespace, InvalidTopicNameError)


def expand_service_name(name: str, node_name: str, namespace: str) -> str:
    """Return the absolute name of a service or action, expanded for a node.

    The rules are those of `expand_topic_name`.

    Raises:
        InvalidServiceNameError: the name is not valid.
    """
    return _expand(name, node_name, namespace, InvalidServiceNameError)


def _expand(
    name: str, node_name: str, namespace: str, error: type[InvalidTopicNameError | InvalidServiceNameError]
) -> str:
    problem = find_topic_name_problem(name)
    if problem is not None:
        raise error(name, *problem)
    full_name = _apply_substitutions(name, node_name, namespace, error) if "{" in name else name
    if full_name.startswith("~"):
        full_name = join(namespace, node_name) + full_name[1:]
    elif not full_name.startswith("/"):
        full_name = join(namespace, full_name)
    if "//" in full_name:
        raise error(name, phrase("topic name must not contain repeated '/'"), name.find("{"))
    return full_name


def _apply_substitutions(
    name: str, node_name: str, namespace: str, error: type[InvalidTopicNameError | InvalidServiceNameError]
) -> str:
    substitutions = {"node": node_name, "ns": namespace, "namespace": namespace}

    def substitute(match: re.Match[str]) -> str:
        value = substitutions.get(match[1])
        if value is None:
            raise error(name, phrase("unknown substitution '{{{match}}}'", match=match[1]), match.start())
        return value

    return _SUBSTITUTION.sub(substitute, name)


@dataclass(frozen=True, slots=True)
class NodeIdentity:
    """A node's name in the graph.

    Attributes:
        name: the name without namespace.
        namespace: the absolute namespace.
        enclave: the security enclave; ``/`` if there is none.
    """

    name: str
    namespace: str
    enclave: str = "/"

    @property
    def full_name(self) -> str:
        """The absolute namespace joined with the name."""
        return join(self.namespace, self.name)


_TOPIC_SCHEME, _SERVICE_SCHEME = "rostopic://", "rosservice://"
_NODE_NAME_SOURCES = ("__node", "__name")
_NAMESPACE_SOURCE = "__ns"


@dataclass(frozen=True, slots=True)
class _Rule:
    """A parsed remapping rule.

    Attributes:
        node: the only node that the rule applies to; None for all nodes.
        scheme: ``rostopic://`` or ``rosservice://`` for a rule for topics or services only; empty for both.
        source: the name to replace, as written.
        target: the new name, as written.
    """

    node: str | None
    scheme: str
    source: str
    target: str


class Remappings:
    """A node's remapping rules.

    The first rule that matches a name is applied.

    ``__node`` (or ``__name``) and ``__ns`` rename the node itself. A rule may start with the name of the node that it
    applies to (``talker:chatter``). The prefix ``rostopic://`` or ``rosservice://`` restricts it to topics or services.

    Args:
        rules: the two sides of each rule, ``from`` and ``to``.

    Raises:
        LinkwrightError: a rule has a wildcard, which rcl does not support either (GRAPH102).
    """

    __slots__ = ("_rules",)

    def __init__(self, rules: Iterable[tuple[str, str]] = ()) -> None:
        self._rules = tuple(_parse_rule(source, target) for source, target in rules)

    def node_name(self, name: str) -> str:
        """Return the remapped name of a node, or the given name if no rule applies."""
        return next(
            (rule.target for rule in self._rules if rule.source in _NODE_NAME_SOURCES and rule.node in (None, name)),
            name,
        )

    def namespace(self, namespace: str, node_name: str) -> str:
        """Return the remapped namespace of a node, or the given namespace if no rule applies."""
        return next(
            (
                rule.target
                for rule in self._rules
                if rule.source == _NAMESPACE_SOURCE and rule.node in (None, node_name)
            ),
            namespace,
        )

    def topic(self, full_name: str, node_name: str, namespace: str) -> str:
        """Return the remapped absolute name of a topic, or `full_name` if no rule applies.

        Both sides of a rule are expanded in the same way as the node's own names.

        Raises:
            InvalidTopicNameError: a side of a rule is not a valid topic name.
        """
        for rule in self._rules:
            if rule.source.startswith("__") or rule.scheme == _SERVICE_SCHEME or rule.node not in (None, node_name):
                continue
            if expand_topic_name(rule.source, node_name, namespace) == full_name:
                return expand_topic_name(rule.target, node_name, namespace)
        return full_name

    def service(self, full_name: str, node_name: str, namespace: str) -> str:
        """Return the remapped absolute name of a service, or `full_name` if no rule applies.

        Raises:
            InvalidServiceNameError: a side of a rule is not a valid name.
        """
        for rule in self._rules:
            if rule.source.startswith("__") or rule.scheme == _TOPIC_SCHEME or rule.node not in (None, node_name):
                continue
            if expand_service_name(rule.source, node_name, namespace) == full_name:
                return expand_service_name(rule.target, node_name, namespace)
        return full_name


def _parse_rule(source: str, target: str) -> _Rule:
    node = None
    node_name, colon, remainder = source.partition(":")
    if colon and not remainder.startswith("//"):
        node, source = node_name, remainder
    scheme = next((prefix for prefix in (_TOPIC_SCHEME, _SERVICE_SCHEME) if source.startswith(prefix)), "")
    name = source[len(scheme) :]
    if scheme and target.startswith(scheme):
        target = target[len(scheme) :]
    if "*" in name:
        raise LinkwrightError(
            Diagnostic(
                "GRAPH102",
                phrase(
                    "remapping rule '{source}:={target}' has a wildcard, which ROS 2 does not support",
                    source=source,
                    target=target,
                ),
                hint=phrase("write a rule for each name"),
            )
        )
    return _Rule(node, scheme, name, target)
