"""Validation and expansion of names, as in several modules of rclpy."""

from __future__ import annotations

from linkwright.graph.names import rules as names
from linkwright.graph.parameters.parameter import InvalidParameterException

TOPIC_SEPARATOR_STRING = "/"
HIDDEN_TOPIC_PREFIX = "_"


def validate_node_name(node_name: str) -> bool:
    """Return True for a valid node name.

    Raises:
        InvalidNodeNameError: the name is not valid.
    """
    names.check_node_name(node_name)
    return True


def validate_namespace(namespace: str) -> bool:
    """Return True for a valid namespace.

    Raises:
        InvalidNamespaceError: the namespace is not valid.
    """
    problem = names.find_namespace_problem(namespace)
    if problem is not None:
        raise names.InvalidNamespaceError(namespace, *problem)
    return True


def validate_topic_name(name: str, *, is_service: bool = False) -> bool:
    """Return True for a valid topic or service name.

    The name may be relative or private.

    Raises:
        InvalidTopicNameError, InvalidServiceNameError: the name is not valid.
    """
    _raise_if_invalid(name, names.find_topic_name_problem(name), is_service=is_service)
    return True


def validate_full_topic_name(name: str, *, is_service: bool = False) -> bool:
    """Return True for a valid absolute name of a topic or service.

    Raises:
        InvalidTopicNameError, InvalidServiceNameError: the name is not valid.
    """
    problem = names.find_topic_name_problem(name)
    if problem is None and not name.startswith("/"):
        problem = "topic name must be absolute, it must lead with a '/'", 0
    _raise_if_invalid(name, problem, is_service=is_service)
    return True


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """Return the absolute name of a topic for a name that a node uses.

    Raises:
        ValueError: one of the names is not valid.
    """
    try:
        validate_node_name(node_name)
        validate_namespace(node_namespace)
        return names.expand_topic_name(topic_name, node_name, node_namespace)
    except names.InvalidNameError as error:
        raise ValueError(f"{error.kind} is invalid: {error}") from error


def topic_or_service_is_hidden(name: str) -> bool:
    """Return whether tools hide a topic or service by default.

    A name is hidden if one of its parts begins with ``_``.
    """
    return names.is_hidden(name)


def validate_parameter_name(name: str) -> bool:
    """Return True for a valid parameter name.

    Every name that is not empty is valid.

    Raises:
        InvalidParameterException: the name is empty.
    """
    if not name:
        raise InvalidParameterException(name)
    return True


def _raise_if_invalid(name: str, problem: names.Problem | None, *, is_service: bool) -> None:
    if problem is None:
        return
    if is_service:
        raise names.InvalidServiceNameError(name, *problem)
    raise names.InvalidTopicNameError(name, *problem)
