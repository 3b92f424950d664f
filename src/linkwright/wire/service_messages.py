"""Requests and responses as bytes and back, for all transports."""

from __future__ import annotations

from typing import Any, Literal

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import deserialize, serialize


def read_or_warn(body: bytes, half: Literal["Request", "Response"], endpoint: Any) -> Any:
    """A request or response; None when it cannot be read, which is logged.

    Args:
        body: CDR with its header; handed on as it is to an endpoint that is raw.
        half: which of the two.
        endpoint: the client or service that it is for.
    """
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
