"""Announcements of participants (SPDP) and endpoints (SEDP).

Source: DDSI-RTPS 2.5, 8.5 and 9.6.2.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

from linkwright.wire.dds.rtps import values as v
from linkwright.wire.dds.rtps.messages import Data
from linkwright.wire.dds.rtps.values import Address, MalformedError, Parameters

_LITTLE_ENDIAN_LIST = b"\x00\x03\x00\x00"
_BIG_ENDIAN_LIST = b"\x00\x02"
_GONE_FLAGS = 0x03
"""The status flags for disposed and unregistered entities."""

_MAX_LEASE_S = 300.0
_DEFAULT_LEASE_S = 100.0


@dataclass(frozen=True, slots=True)
class ParticipantData:
    """The announcement of a participant.

    Attributes:
        prefix: the prefix of the participant's GUIDs.
        vendor: the vendor of the implementation.
        lease_s: the seconds of silence after which the participant counts as gone.
        discovery_addresses: the addresses for discovery.
        user_addresses: the addresses of the participant's readers and writers that do not announce their own.
    """

    prefix: bytes
    vendor: bytes
    lease_s: float
    discovery_addresses: tuple[Address, ...]
    user_addresses: tuple[Address, ...]


@dataclass(frozen=True, slots=True)
class EndpointData:
    """The announcement of a remote reader or writer.

    Without `addresses`, the endpoint listens at the addresses of its participant.
    """

    guid: bytes
    topic: str
    type_name: str
    is_reliable: bool
    addresses: tuple[Address, ...]


def describe_participant(prefix: bytes, name: str, lease: float, addresses: list[Address]) -> bytes:
    """Return the SPDP sample that announces one of our participants."""
    return _LITTLE_ENDIAN_LIST + v.encode_parameters(
        (v.PID_PROTOCOL_VERSION, v.VERSION),
        (v.PID_VENDOR, v.OWN_VENDOR),
        (v.PID_PARTICIPANT_GUID, prefix + v.PARTICIPANT),
        *((v.PID_METATRAFFIC_UNICAST_LOCATOR, v.encode_locator(address)) for address in addresses),
        *((v.PID_DEFAULT_UNICAST_LOCATOR, v.encode_locator(address)) for address in addresses),
        (v.PID_LEASE, struct.pack("<iI", int(lease), 0)),
        (v.PID_BUILTIN_ENDPOINTS, struct.pack("<I", v.BUILTIN_ENDPOINTS)),
        (v.PID_ENTITY_NAME, v.encode_text(name)),
    )


def describe_endpoint(guid: bytes, topic: str, type_name: str, user_data: bytes) -> bytes:
    """Return the SEDP sample that announces one of our readers or writers.

    The announced QoS is reliable and volatile, as for services.
    """
    return _LITTLE_ENDIAN_LIST + v.encode_parameters(
        (v.PID_ENDPOINT_GUID, guid),
        (v.PID_PARTICIPANT_GUID, guid[: v.PREFIX_SIZE] + v.PARTICIPANT),
        (v.PID_TOPIC_NAME, v.encode_text(topic)),
        (v.PID_TYPE_NAME, v.encode_text(type_name)),
        (v.PID_RELIABILITY, v.RELIABLE),
        (v.PID_DURABILITY, v.VOLATILE),
        (v.PID_USER_DATA, v.encode_octets(user_data)),
        (v.PID_PROTOCOL_VERSION, v.VERSION),
        (v.PID_VENDOR, v.OWN_VENDOR),
        (v.PID_KEY_HASH, guid),
    )


def make_key_parameters(guid: bytes, *, is_gone: bool = False) -> bytes:
    """Return the inline QoS that identifies an endpoint.

    If `is_gone` is true, the inline QoS also announces that the endpoint was deleted.
    """
    status = ((v.PID_STATUS_INFO, bytes((0, 0, 0, _GONE_FLAGS))),) if is_gone else ()
    return v.encode_parameters((v.PID_KEY_HASH, guid), *status)


def find_departed_guid(sample: Data) -> bytes:
    """Return the GUID of the participant or endpoint that a sample announces as gone.

    The GUID is empty if the sample announces no departure.

    Raises:
        MalformedError: the sample announces a departure without a GUID.
    """
    status = sample.inline.get(v.PID_STATUS_INFO)
    if not status or not status[0][3:4] or not status[0][3] & _GONE_FLAGS:
        return b""
    key = sample.inline.get(v.PID_KEY_HASH)
    if key is None and sample.payload is not None:
        parameters, _ = _read_list(sample.payload)
        key = parameters.get(v.PID_ENDPOINT_GUID) or parameters.get(v.PID_PARTICIPANT_GUID)
    if not key or len(key[0]) < 16:
        raise MalformedError("a disposed entity has no GUID")
    return key[0][:16]


def read_participant(payload: bytes) -> ParticipantData:
    """Parse the SPDP sample of a participant.

    Raises:
        MalformedError: a required value is missing.
    """
    parameters, order = _read_list(payload)
    lease_s = _DEFAULT_LEASE_S
    for value in parameters.get(v.PID_LEASE, ()):
        if len(value) >= 8:
            lease_s = min(float(struct.unpack_from(order + "i", value)[0] & 0x7FFF_FFFF), _MAX_LEASE_S)
    return ParticipantData(
        prefix=_get_required_value(parameters, v.PID_PARTICIPANT_GUID, 16)[: v.PREFIX_SIZE],
        vendor=_get_required_value(parameters, v.PID_VENDOR, 2)[:2],
        lease_s=lease_s,
        discovery_addresses=tuple(v.read_locators(parameters.get(v.PID_METATRAFFIC_UNICAST_LOCATOR, []), order)),
        user_addresses=tuple(v.read_locators(parameters.get(v.PID_DEFAULT_UNICAST_LOCATOR, []), order)),
    )


def read_endpoint(payload: bytes, *, is_writer: bool) -> EndpointData:
    """Parse the SEDP sample of a reader or writer.

    Raises:
        MalformedError: a required value is missing.
    """
    parameters, order = _read_list(payload)
    is_reliable = is_writer
    for value in parameters.get(v.PID_RELIABILITY, ()):
        is_reliable = len(value) >= 4 and struct.unpack_from(order + "I", value)[0] == 2
    return EndpointData(
        guid=_get_required_value(parameters, v.PID_ENDPOINT_GUID, 16)[:16],
        topic=v.read_text(_get_required_value(parameters, v.PID_TOPIC_NAME, 4), order),
        type_name=v.read_text(_get_required_value(parameters, v.PID_TYPE_NAME, 4), order),
        is_reliable=is_reliable,
        addresses=tuple(v.read_locators(parameters.get(v.PID_UNICAST_LOCATOR, []), order)),
    )


def _read_list(payload: bytes) -> tuple[Parameters, str]:
    order = ">" if payload[:2] == _BIG_ENDIAN_LIST else "<"
    return v.read_parameters(payload, 4, order)[0], order


def _get_required_value(parameters: Parameters, pid: int, size: int) -> bytes:
    values = parameters.get(pid)
    if not values or len(values[0]) < size:
        raise MalformedError(f"parameter {pid:#06x} is missing or too short")
    return values[0]
