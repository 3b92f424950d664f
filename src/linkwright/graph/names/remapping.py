"""Remapping rules: other names for a node and for the topics and services it uses (rcl ``remap``)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph.names.rules import expand_service_name, expand_topic_name

_TOPIC, _SERVICE = "rostopic://", "rosservice://"
_NODE_NAMES = ("__node", "__name")
_NAMESPACE = "__ns"


@dataclass(frozen=True, slots=True)
class _Rule:
    """One rule, taken apart.

    Attributes:
        node: the only node that it is for; None for all.
        kind: ``rostopic://`` or ``rosservice://`` for a rule of one kind of names; empty for both.
        source: the name to replace, as written.
        target: the name to use instead, as written.
    """

    node: str | None
    kind: str
    source: str
    target: str


class Remappings:
    """A node's remapping rules; the first that fits is taken.

    ``__node`` (or ``__name``) and ``__ns`` rename the node itself. A rule may begin with the name of the node it is
    for (``talker:chatter``), and with ``rostopic://`` or ``rosservice://`` for names of one kind.

    Args:
        rules: the sides of each rule, ``from`` and ``to``.

    Raises:
        LinkwrightError: a rule has a wildcard, which rcl does not know either (GRAPH102).
    """

    __slots__ = ("_rules",)

    def __init__(self, rules: Iterable[tuple[str, str]] = ()) -> None:
        self._rules = tuple(_taken_apart(source, target) for source, target in rules)

    def node_name(self, name: str) -> str:
        """The name the node is to bear instead of the one its code gives."""
        return next((r.target for r in self._rules if r.source in _NODE_NAMES and r.node in (None, name)), name)

    def namespace(self, namespace: str, node_name: str) -> str:
        """The namespace the node is to live in instead of the one its code gives."""
        return next(
            (r.target for r in self._rules if r.source == _NAMESPACE and r.node in (None, node_name)), namespace
        )

    def topic(self, full_name: str, node_name: str, namespace: str) -> str:
        """The topic to use instead of an expanded one. Both sides of a rule are expanded as the node's own names are.

        Raises:
            InvalidTopicNameError: a side of a rule is not a valid topic name.
        """
        for rule in self._rules:
            if rule.source.startswith("__") or rule.kind == _SERVICE or rule.node not in (None, node_name):
                continue
            if expand_topic_name(rule.source, node_name, namespace) == full_name:
                return expand_topic_name(rule.target, node_name, namespace)
        return full_name

    def service(self, full_name: str, node_name: str, namespace: str) -> str:
        """The service to use instead of an expanded one.

        Raises:
            InvalidServiceNameError: a side of a rule is not a valid name.
        """
        for rule in self._rules:
            if rule.source.startswith("__") or rule.kind == _TOPIC or rule.node not in (None, node_name):
                continue
            if expand_service_name(rule.source, node_name, namespace) == full_name:
                return expand_service_name(rule.target, node_name, namespace)
        return full_name


def _taken_apart(source: str, target: str) -> _Rule:
    node = None
    before, colon, rest = source.partition(":")
    if colon and not rest.startswith("//"):
        node, source = before, rest
    kind = next((prefix for prefix in (_TOPIC, _SERVICE) if source.startswith(prefix)), "")
    name = source[len(kind) :]
    if kind and target.startswith(kind):
        target = target[len(kind) :]
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
    return _Rule(node, kind, name, target)
