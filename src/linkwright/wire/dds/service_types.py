"""The types and the USER_DATA of services, in the forms of Cyclone and of Fast DDS."""

from __future__ import annotations

from linkwright.graph.endpoints.base import Endpoint
from linkwright.messages import InterfaceNotFoundError, type_hash
from linkwright.wire.dds.names import format_endpoint_id


def make_service_user_data(identity: bytes, endpoint: Endpoint, *, is_server: bool) -> bytes:
    """Return the USER_DATA that links both endpoints of a client or server.

    Args:
        identity: 16 bytes that are unique to the client or server.
        endpoint: the client or the service.
        is_server: whether `endpoint` is a service.
    """
    key = "serviceid" if is_server else "clientid"
    hash_text = _find_announced_hash(endpoint)
    return (f"{key}={format_endpoint_id(identity)};" + (f"typehash={hash_text};" if hash_text else "")).encode()


def request_and_response_types(service_type: str) -> tuple[str, str]:
    """Return the ROS type names of the request and response of a service type.

    An example of a service type is ``std_srvs/srv/SetBool``.
    """
    return f"{service_type}_Request", f"{service_type}_Response"


def _find_announced_hash(endpoint: Endpoint) -> str:
    """Return the announced or computed hash of a service's type, or an empty string."""
    if endpoint.type_hash:
        return endpoint.type_hash
    try:
        return type_hash(endpoint.type_name)
    except InterfaceNotFoundError:
        if not endpoint.raw:
            raise
        return ""
