"""The listening socket of the web server."""

from __future__ import annotations

import errno
import ipaddress
import os
import socket

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase

DEFAULT_PORT = 7448
"""The port after 7447, on which Zenoh routers listen (decision 0066)."""

_PORT_COUNT = 10
_WILDCARDS = {"0.0.0.0": "127.0.0.1", "::": "::1"}  # noqa: S104 - not bound here, only replaced in URLs


def listen(host: str, port: int | None) -> socket.socket:
    """Return a listening socket.

    Args:
        host: a name or address of this machine.
        port: the port; 0 for any free port; None for `DEFAULT_PORT` or the next free port.

    Raises:
        LinkwrightError: VIEW101, the requested port is in use; VIEW102, it is not possible to listen on the port;
            VIEW103, the host is unknown.
    """
    try:
        family, _, _, _, address = socket.getaddrinfo(host, 0, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
    except (OSError, UnicodeError):
        hint = phrase("use 127.0.0.1, or 0.0.0.0 to accept connections from other machines")
        message = phrase("'{host}' is not a name or address of this machine", host=host)
        raise LinkwrightError(Diagnostic("VIEW103", message, hint=hint)) from None
    candidates = [port] if port is not None else [*range(DEFAULT_PORT, DEFAULT_PORT + _PORT_COUNT), 0]
    for candidate in candidates:
        try:
            return _listen_at(family, (address[0], candidate))
        except OSError as error:  # noqa: PERF203 - few ports, and each may be in use
            if candidate == candidates[-1] or error.errno != errno.EADDRINUSE:
                raise LinkwrightError(_cannot_listen(host, candidate, error)) from None
    raise AssertionError("the last port listens or raises")


def url_of(listener: socket.socket) -> str:
    """Return the URL with which a browser on this machine reaches a listening socket."""
    host, port = listener.getsockname()[:2]
    host = _WILDCARDS.get(host, host)
    return f"http://[{host}]:{port}/" if ":" in host else f"http://{host}:{port}/"


def is_open_to_others(listener: socket.socket) -> bool:
    """Return whether other machines can reach a listening socket."""
    return not ipaddress.ip_address(listener.getsockname()[0].partition("%")[0]).is_loopback


def _listen_at(family: int, address: tuple[str | int, int]) -> socket.socket:
    listener = socket.socket(family, socket.SOCK_STREAM)
    try:
        if os.name == "posix":
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
        listener.listen(64)  # several programs may bind a port, but `listen` fails for all except one
        listener.setblocking(False)
    except (OSError, OverflowError) as error:
        listener.close()
        if isinstance(error, OverflowError):
            raise OSError(errno.EINVAL, phrase("the port must be from 0 to 65535")) from None
        raise
    return listener


def _cannot_listen(host: str, port: int, error: OSError) -> Diagnostic:
    if error.errno == errno.EADDRINUSE:
        hint = phrase("choose another port with '--port', or omit '--port' to use the next free one")
        return Diagnostic("VIEW101", phrase("port {port} of '{host}' is in use", port=port, host=host), hint=hint)
    return Diagnostic(
        "VIEW102",
        phrase(
            "cannot listen on port {port} of '{host}': {strerror}",
            port=port,
            host=host,
            strerror=foreign(error.strerror or error),
        ),
    )
