"""Find the reasons why a connection to an address fails.

Zenoh does not report these reasons. This module therefore connects to the address with sockets and TLS, as Zenoh does.
"""

from __future__ import annotations

import json
import re
import socket
import ssl
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import zenoh

from linkwright.diagnostics import Phrase, foreign, phrase

_RESPONSE_TIMEOUT_S = 2.0
"""Seconds within which an address must answer."""

_ADDRESS = re.compile(r"(?P<kind>\w+)/(?P<host>\[[^]]+\]|[^:/?#]+):(?P<port>\d+)(?:[?#].*)?")
_LAST_PORT = 65535
_CHECKED_KINDS = ("tcp", "tls")
"""The kinds of addresses that this module checks; it ignores others, such as QUIC, UDP and serial lines."""


def find_configured_addresses(config: zenoh.Config) -> list[str]:
    """Return the addresses that a session with the given configuration connects to."""
    addresses = get_mode_value(config, "connect/endpoints", default=[])
    flat = [address for group in addresses for address in (group if isinstance(group, list) else [group])]
    return [str(address) for address in flat]


def get_mode_value(config: zenoh.Config, key: str, *, default: Any) -> Any:
    """Return the value of a setting for the session's mode, or `default` if it is not set.

    The setting may differ by mode, such as ``{client: 0, peer: -1}``.
    """
    value = json.loads(config.get_json(key))
    if isinstance(value, dict):
        value = value.get(json.loads(config.get_json("mode")) or "peer")
    return default if value is None else value


def find_connection_problems(config: zenoh.Config) -> list[Phrase]:
    """Return the known reasons why a session cannot connect to its addresses."""
    tls = json.loads(config.get_json("transport/link/tls")) or {}
    found = [found for address in find_configured_addresses(config) if (found := find_connection_problem(address, tls))]
    if not found and json.loads(config.get_json("id")) is not None:
        found.append(phrase("the process at this address may have the same 'id': leave 'id' out of the configuration"))
    return found


def find_connection_problem(address: str, tls: Mapping[str, Any]) -> Phrase:
    """Return the reason why a connection to an address fails.

    Return an empty phrase if no reason is found.

    Args:
        address: the address, such as ``tls/cloud.example.com:7448``.
        tls: the settings below ``transport/link/tls``.
    """
    match = _ADDRESS.fullmatch(address)
    if match is None:
        if address.partition("/")[0] not in _CHECKED_KINDS:
            return Phrase("")
        return phrase("'{address}' is not an address: write it as tcp/HOST:PORT or tls/HOST:PORT", address=address)
    if match["kind"] not in _CHECKED_KINDS:
        return Phrase("")
    host, port = match["host"].strip("[]"), int(match["port"])
    if port > _LAST_PORT:
        return phrase("'{address}' is not an address: its port must be at most 65535", address=address)
    try:
        with socket.create_connection((host, port), _RESPONSE_TIMEOUT_S) as connection:
            return (
                _find_tls_obstacle(address, connection, host, tls)
                if match["kind"] == "tls"
                else _find_protocol_obstacle(address, connection)
            )
    except socket.gaierror as error:
        return phrase(
            "the host name of {address} cannot be resolved: {reason}", address=address, reason=_describe_error(error)
        )
    except ConnectionRefusedError:
        return phrase("nothing listens at {address}: start a router there, or correct the port", address=address)
    except TimeoutError:
        return phrase(
            "{address} does not respond: its machine is off or unreachable, or a firewall blocks it",
            address=address,
        )
    except OSError as error:
        return phrase("{address} is unreachable: {reason}", address=address, reason=_describe_error(error))


def _find_protocol_obstacle(address: str, connection: socket.socket) -> Phrase:
    """Send a first Zenoh message, and return a reason if the listener answers with TLS.

    Otherwise the phrase is empty.
    """
    connection.settimeout(_RESPONSE_TIMEOUT_S / 4)
    try:
        connection.sendall(b"\x04\0\x01\x08\0\0")
        response = connection.recv(16)
    except TimeoutError:
        return Phrase("")
    except OSError:
        response = b""
    is_tls = response[:1] == b"\x15"
    if is_tls:
        return phrase("the process at {address} speaks TLS: write tls/ in place of tcp/", address=address)
    return Phrase("")


def _find_tls_obstacle(address: str, connection: socket.socket, host: str, tls: Mapping[str, Any]) -> Phrase:
    if any(
        tls.get(f"{setting}_base64")
        for setting in ("root_ca_certificate", "connect_certificate", "connect_private_key")
    ):
        return Phrase("")
    context = ssl.create_default_context()
    context.verify_flags &= ~ssl.VERIFY_X509_STRICT  # Python sets this flag from 3.13 on; Zenoh's TLS is less strict.
    context.check_hostname = tls.get("verify_name_on_connect") is not False
    authority, certificate, key = (
        tls.get(setting) or "" for setting in ("root_ca_certificate", "connect_certificate", "connect_private_key")
    )
    for path in (authority, certificate, key):
        problem = _find_read_problem(path)
        if problem:
            return problem
    try:
        if authority:
            context.load_verify_locations(authority)
    except ssl.SSLError:
        return phrase(
            "'{path}' does not contain the certificate of a certificate authority in PEM format", path=authority
        )
    try:
        if certificate and key and tls.get("enable_mtls"):
            context.load_cert_chain(certificate, key)
    except ssl.SSLError:
        return phrase(
            "'{certificate}' and '{key}' are not a certificate and its key in PEM format",
            certificate=certificate,
            key=key,
        )
    connection.settimeout(_RESPONSE_TIMEOUT_S)
    is_handshake_done = False
    try:
        with context.wrap_socket(connection, server_hostname=host) as tls_connection:
            is_handshake_done = True
            tls_connection.settimeout(_RESPONSE_TIMEOUT_S / 2)
            tls_connection.recv(1)  # With TLS 1.3, a client learns of a refusal only after the handshake.
    except TimeoutError:
        return Phrase("") if is_handshake_done else _describe_missing_tls(address)
    except ssl.SSLCertVerificationError as error:
        return phrase(
            "the certificate of {address} is not accepted: {reason}",
            address=address,
            reason=foreign(error.verify_message.rstrip(".")),
        )
    except ssl.SSLError as error:
        return _describe_tls_failure(address, certificate, str(error.reason or error))
    except OSError as error:
        return phrase(
            "{address} closes the connection during TLS: {reason}", address=address, reason=_describe_error(error)
        )
    return Phrase("")


def _describe_tls_failure(address: str, certificate: str, reason: str) -> Phrase:
    if "WRONG_VERSION" in reason or "RECORD_LAYER" in reason:
        return _describe_missing_tls(address)
    if "CERTIFICATE_REQUIRED" in reason:
        return phrase(
            "{address} requires a client certificate: set enable_mtls, connect_certificate and "
            "connect_private_key below transport/link/tls",
            address=address,
        )
    if "ALERT" in reason:
        return phrase(
            "{address} refuses the certificate '{certificate}': {reason}",
            address=address,
            certificate=certificate,
            reason=foreign(reason.lower().replace("_", " ")),
        )
    return phrase("TLS fails at {address}: {reason}", address=address, reason=foreign(reason.lower().replace("_", " ")))


def _describe_missing_tls(address: str) -> Phrase:
    return phrase("the process at {address} does not speak TLS: write tcp/ in place of tls/", address=address)


def _find_read_problem(path: str) -> Phrase:
    try:
        if path:
            with Path(path).open("rb"):
                pass
    except OSError as error:
        return phrase("cannot read '{path}': {reason}", path=path, reason=_describe_error(error))
    return Phrase("")


def _describe_error(error: OSError) -> Phrase:
    return foreign(error.strerror or error)
