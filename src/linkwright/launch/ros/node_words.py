"""The words of a node's command line: what is filled in when it starts, and names that are checked before."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.context import LaunchContext
from linkwright.launch.places import error_at
from linkwright.launch.substitution import Substitution


class Assigned(Substitution):
    """A word that the node itself fills in when it starts.

    Args:
        what: which one, for those who read about it.
        word: gives it.
    """

    def __init__(self, what: str, word: Callable[[], str]) -> None:
        self._what = what
        self._word = word

    def describe(self) -> str:
        """Which word it is."""
        return f"LocalVar('ros_specific_arguments['{self._what}']')"

    def perform(self, context: LaunchContext) -> str:  # noqa: ARG002 - the interface of substitutions
        """The word."""
        return self._word()


def listed(values: Any) -> list[Any]:
    """Words, or a single one, as a list."""
    if values is None:
        return []
    return [values] if isinstance(values, (str, Substitution)) or not isinstance(values, Iterable) else list(values)


def check_name(name: str) -> str:
    """The name of a node, if it is one.

    Raises:
        LinkwrightError: LAUNCH134, it is not valid.
    """
    from linkwright.graph.names import check_node_name

    try:
        check_node_name(name)
    except LinkwrightError as error:
        reason = error.diagnostics[0].message
        raise error_at(
            None, "LAUNCH134", f"the name '{name}' of a node is malformed: {reason}", promises=error
        ) from error
    return name


def check_namespace(namespace: str) -> str:
    """An absolute namespace, if it is one.

    Raises:
        LinkwrightError: LAUNCH134, it is not valid.
    """
    from linkwright.graph.names import absolute_namespace

    try:
        absolute_namespace(namespace)
    except LinkwrightError as error:
        reason = _reason(error)
        message = f"namespace '{namespace}' is malformed: {reason}"
        raise error_at(None, "LAUNCH134", message, promises=ValueError(message)) from error
    return namespace


def _reason(error: LinkwrightError) -> str:
    """What is wrong with a name, without the name."""
    return error.diagnostics[0].message.rpartition(": ")[2]
