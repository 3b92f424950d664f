"""Read the types of subscriptions and services from their C++ callbacks."""

from __future__ import annotations

import re
from collections.abc import Iterable

_POINTER = re.compile(r"(?:::|(?<=\w))(?:Const)?(?:Shared|Unique|Weak)?Ptr$")
_TEMPLATE = re.compile(r"(?:(?:std|boost)::(?:shared_ptr|unique_ptr)|(?:ros::)?MessageEvent)\s*<(?P<type>[^<>]*)>")
_PARAMETER = re.compile(r"(?P<type>.*?[\s&*>])?(?P<name>\w*)", re.DOTALL)


def find_message_type(function: str, texts: Iterable[str]) -> str:
    """Return the message type of a callback as written; empty if it is unknown.

    Args:
        function: the name of the function without its class.
        texts: the texts, without comments, in which the function may be defined or declared.
    """
    parameter = r"(?P<parameter>[^(),]*(?:<[^<>()]*>[^(),]*)?)"
    pattern = re.compile(rf"\b{re.escape(function)}\s*\({parameter}\)\s*(?:const\s*)?[;{{]")
    for text in texts:
        types = {_parse_message_type(match["parameter"]) for match in pattern.finditer(text)} - {""}
        if types:
            return types.pop() if len(types) == 1 else ""
    return ""


def find_service_type(function: str, texts: Iterable[str]) -> str:
    """Return the type of the service that calls a function of ROS 1, as written; empty if it is unknown.

    The function takes a request such as ``std_srvs::Empty::Request`` or ``std_srvs::EmptyRequest``.

    Args:
        function: the name of the function without its class.
        texts: the texts, without comments, in which the function may be defined or declared.
    """
    pattern = re.compile(rf"\b{re.escape(function)}\s*\(\s*(?:const\s+)?(?P<type>(?:\w+::)+\w+?)(?:::)?Request\s*&")
    for text in texts:
        types = {match["type"] for match in pattern.finditer(text)}
        if types:
            return types.pop() if len(types) == 1 else ""
    return ""


def _parse_message_type(parameter: str) -> str:
    """Return the message type of a parameter such as ``const std_msgs::BoolConstPtr& msg``."""
    match = _PARAMETER.fullmatch(parameter.strip())
    type_name = match["type"] or "" if match is not None else ""
    type_name = re.sub(r"\bconst\b|[&*\s]", " ", type_name).strip()
    template = _TEMPLATE.fullmatch(type_name)
    name = template["type"].strip() if template is not None else _POINTER.sub("", type_name)
    return name if re.fullmatch(r"(?:\w+::)+[A-Z]\w*", name) else ""
