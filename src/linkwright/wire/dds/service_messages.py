"""What the two ways to call services over DDS share: with Cyclone, and with participants of Fast DDS."""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import deserialize, type_hash
from linkwright.wire.dds.names import endpoint_id


def service_facts(identity: bytes, service: Any, *, is_server: bool) -> bytes:
    """The USER_DATA of both endpoints of a client or a server, which names them as belonging together.

    Args:
        identity: 16 bytes of their own.
        service: the service's class.
        is_server: which of the two.
    """
    key = "serviceid" if is_server else "clientid"
    return f"{key}={endpoint_id(identity)};typehash={type_hash(service)};".encode()


def read_or_warn(body: bytes, message_class: Any, endpoint: Any) -> Any:
    """A request or response; None when it cannot be read, which is logged.

    Args:
        body: CDR with its header.
        message_class: what to read it as.
        endpoint: the client or service that it is for.
    """
    try:
        return deserialize(body, message_class)
    except LinkwrightError as error:
        endpoint.node.logger.warning(f"Dropped a malformed message of service '{endpoint.name}': {error}")
        return None
