"""Serialize and deserialize requests and responses, for all transports.

This happens in transport threads, which also serve other endpoints. A failure there is logged like the failure of a
callback, and does not propagate.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

from linkwright.diagnostics import LinkwrightError
from linkwright.graph.endpoints.service import RequestId
from linkwright.messages import deserialize, serialize


def forward_request(body: bytes, service: Any, reply: Callable[[Any], None], request_id: RequestId) -> bool:
    """Pass a request to a service.

    Args:
        body: CDR with its header; passed on unchanged to a raw service.
        service: the service.
        reply: called with the response.
        request_id: the request's client and sequence number.

    Returns:
        Whether the service accepted the request. If it did not, the reason is logged.
    """
    try:
        request = _read_or_warn(body, "Request", service)
        if request is not None:
            service.receive(request, reply, request_id)
    except Exception as error:  # noqa: BLE001 - others depend on this thread
        service.report(error)
        return False
    return request is not None


def forward_response(body: bytes, client: Any, on_response: Callable[[Any], None]) -> None:
    """Pass a response to the caller that waits for it.

    If the response cannot be decoded, the reason is logged.

    Args:
        body: CDR with its header; passed on unchanged to a raw client.
        client: the client.
        on_response: called with the response.
    """
    try:
        response = _read_or_warn(body, "Response", client)
        if response is not None:
            on_response(response)
    except Exception as error:  # noqa: BLE001 - others depend on this thread
        client.report(error)


def _read_or_warn(body: bytes, message_kind: Literal["Request", "Response"], endpoint: Any) -> Any:
    """Deserialize a request or response.

    If that fails, log the reason and return None.
    """
    if endpoint.raw:
        return body
    try:
        return deserialize(body, getattr(endpoint.srv_type, message_kind))
    except LinkwrightError as error:
        endpoint.node.logger.warning(f"Dropped a malformed message of service '{endpoint.name}': {error}")
        return None


def to_cdr(message: Any) -> bytes:
    """Serialize a request or response to CDR with its header.

    Bytes are returned unchanged.
    """
    return message if type(message) is bytes else serialize(message)
