"""The service of a node that describes the types it uses: ``~/get_type_description`` (REP 2016; Iron and newer)."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from linkwright.graph.endpoints.base import Endpoint
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.messages import InterfaceNotFoundError, definition_text, get_message, is_before_iron

PARAMETER = "start_type_description_service"
"""The parameter that decides whether a node has the service."""

_TYPE = "type_description_interfaces/srv/GetTypeDescription"
_HASH = re.compile(r"RIHS01_[0-9a-f]{64}")


def is_usual(variables: Mapping[str, str] = os.environ) -> bool:
    """Whether nodes of the distribution in ``ROS_DISTRO`` have the service; without one, they are those of Humble."""
    return not is_before_iron(variables)


class TypeDescriptions:
    """The service. It answers for the types of the node's publishers, subscriptions, services and clients.

    Args:
        handle: the node's.
        create_service: its `Node.create_service`.
    """

    def __init__(self, handle: NodeHandle, create_service: Callable[..., object]) -> None:
        self._handle = handle
        create_service(_TYPE, f"{handle.identity.name}/get_type_description", self._answer)

    def _answer(self, request: Any, response: Any) -> Any:
        response.successful = False
        if not _HASH.fullmatch(request.type_hash):
            response.failure_reason = "Failed to parse type hash"
            return response
        found = next((name for name in self._in_use() if _is_asked_for(name, request)), None)
        if found is None:
            response.failure_reason = "Type not currently in use by this node"
            return response
        from linkwright.messages.definitions.hashing import type_description
        from linkwright.messages.definitions.library import LIBRARY

        described = type_description(LIBRARY.definition(found))
        nested = described["referenced_type_descriptions"]
        response.type_description = _interface("TypeDescription")(
            type_description=_individual(described["type_description"]),
            referenced_type_descriptions=[_individual(nested_type) for nested_type in nested],
        )
        if request.include_type_sources:
            response.type_sources = [
                _source(name) for name in (found, *(nested_type["type_name"] for nested_type in nested))
            ]
        response.successful = True
        return response

    def _in_use(self) -> Iterator[str]:
        """The names of the types, each once."""
        return iter(dict.fromkeys(endpoint.type_name for endpoint in self._handle.parts(Endpoint)))


def _is_asked_for(name: str, request: Any) -> bool:
    if request.type_name not in ("", name):
        return False
    from linkwright.messages import type_hash

    try:
        return type_hash(name) == str(request.type_hash)
    except InterfaceNotFoundError:  # an endpoint for bytes, whose type is not known here
        return False


def _interface(name: str) -> Any:
    return get_message(f"type_description_interfaces/msg/{name}")


def _individual(described: Mapping[str, Any]) -> Any:
    """An IndividualTypeDescription; defaults are not in it, as they are not part of the hash."""
    field, field_type = _interface("Field"), _interface("FieldType")
    fields = [field(name=member["name"], type=field_type(**member["type"])) for member in described["fields"]]
    return _interface("IndividualTypeDescription")(type_name=described["type_name"], fields=fields)


def _source(name: str) -> Any:
    """The text of an interface file. A type without a file of its own, such as a request, is ``implicit``."""
    _, encoding, own_name = name.split("/")
    if "_" in own_name:
        return _interface("TypeSource")(type_name=name, encoding="implicit")
    return _interface("TypeSource")(type_name=name, encoding=encoding, raw_file_contents=definition_text(name))
