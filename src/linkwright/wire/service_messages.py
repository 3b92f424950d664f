"""Requests and responses as bytes and back, for all transports.

They are handed on in threads of transports, which others depend on: a failure there is logged as the failure of a
callback is, and ends there.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

from linkwright.diagnostics import LinkwrightError
from linkwright.graph.endpoints.service import RequestId
from linkwright.messages import deserialize, serialize


def hand_request_on(body: bytes, service: Any, reply: Callable[[Any], None], request_id: RequestId) -> bool:
    """Have a service answer a request.

    Args:
        body: CDR with its header; handed on as it is to a service that is raw.
        service: the service.
        reply: called with the response.
        request_id: the client and the request's number.

    Returns:
        Whether the service has it; why not is logged.
    """
    try:
        request = _read_or_warn(body, "Request", service)
        if request is not None:
            service.receive(request, reply, request_id)
    except Exception as error:  # noqa: BLE001 - others depend on this thread
        service.report(error)
        return False
    return request is not None


def hand_response_on(body: bytes, client: Any, answer: Callable[[Any], None]) -> None:
    """Give a client's response to the caller that waits for it; a response that cannot be read is logged.

    Args:
        body: CDR with its header; handed on as it is to a client that is raw.
        client: the client.
        answer: receives the response.
    """
    try:
        response = _read_or_warn(body, "Response", client)
        if response is not None:
            answer(response)
    except Exception as error:  # noqa: BLE001 - others depend on this thread
        client.report(error)


def _read_or_warn(body: bytes, half: Literal["Request", "Response"], endpoint: Any) -> Any:
    """A request or response; None when it cannot be read, which is logged."""
    if endpoint.raw:
        return body
    try:
        return deserialize(body, getattr(endpoint.srv_type, half))
    except LinkwrightError as error:
        endpoint.node.logger.warning(f"Dropped a malformed message of service '{endpoint.name}': {error}")
        return None


def written(message: Any) -> bytes:
    """The CDR of a request or response, with its header; of one that is bytes, those."""
    return message if type(message) is bytes else serialize(message)
