"""Messages of the Foxglove WebSocket protocol, version 1.

Specification: https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md. Numbers are little endian.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

SUBPROTOCOLS = ("foxglove.websocket.v1", "foxglove.sdk.v1")
"""The accepted subprotocols.

Both have the same messages. Foxglove's SDK uses the second name.
"""

ENCODING = "cdr"
SCHEMA_ENCODING = "ros2msg"

_MESSAGE, _TIME, _SERVICE_RESPONSE, _ASSET = 1, 2, 3, 4
_CLIENT_MESSAGE, _SERVICE_REQUEST = 1, 2


class StatusLevel(IntEnum):
    """The severity of a status message."""

    INFO = 0
    WARNING = 1
    ERROR = 2


class BadFrameError(ValueError):
    """Raised when bytes from a client are not a message of the protocol.

    The error message gives the reason.
    """


@dataclass(frozen=True, slots=True)
class ClientMessage:
    """A message from a client on a channel that the client advertised."""

    channel: int
    data: bytes


@dataclass(frozen=True, slots=True)
class ServiceRequest:
    """A service request of a client."""

    service: int
    call: int
    encoding: str
    data: bytes


def encode_message(subscription: int, time_ns: int, data: bytes) -> bytes:
    """Encode a binary frame with a message of a channel."""
    return struct.pack("<BIQ", _MESSAGE, subscription, max(0, time_ns)) + data


def encode_time(time_ns: int) -> bytes:
    """Encode a binary frame with the time of the graph."""
    return struct.pack("<BQ", _TIME, max(0, time_ns))


def encode_service_response(service: int, call: int, data: bytes) -> bytes:
    """Encode a binary frame with the response of a service."""
    encoding = ENCODING.encode()
    return struct.pack("<BIII", _SERVICE_RESPONSE, service, call, len(encoding)) + encoding + data


def encode_asset(request: int, data: bytes) -> bytes:
    """Encode a binary frame with an asset."""
    return struct.pack("<BIBI", _ASSET, request, 0, 0) + data


def encode_asset_error(request: int, reason: str) -> bytes:
    """Encode a binary frame with the reason why an asset is refused."""
    text = reason.encode()
    return struct.pack("<BIBI", _ASSET, request, 1, len(text)) + text


def read_frame(frame: bytes) -> ClientMessage | ServiceRequest:
    """Return the message in a client's binary frame.

    Raises:
        BadFrameError: the frame is not a message of the protocol.
    """
    try:
        opcode = frame[0]
        if opcode == _CLIENT_MESSAGE:
            (channel,) = struct.unpack_from("<I", frame, 1)
            return ClientMessage(channel, frame[5:])
        if opcode == _SERVICE_REQUEST:
            service, call, length = struct.unpack_from("<III", frame, 1)
            start = 13 + length
            if start > len(frame):
                raise BadFrameError("the message is too short")
            return ServiceRequest(service, call, frame[13:start].decode(), frame[start:])
    except (IndexError, struct.error, UnicodeDecodeError):
        raise BadFrameError("the message is too short") from None
    raise BadFrameError(f"unknown message code {opcode}")


def make_status(level: StatusLevel, message: str) -> dict[str, Any]:
    """Return a status message for the user of the client."""
    return {"op": "status", "level": int(level), "message": message}
