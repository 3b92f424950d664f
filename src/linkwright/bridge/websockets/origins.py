"""Decide which web pages may connect.

Any page that a user opens could otherwise connect to a server of this machine.
"""

from __future__ import annotations

import ipaddress
from collections.abc import Collection
from urllib.parse import urlsplit

_APPLICATIONS = ("foxglove.dev", "lichtblick-suite.github.io")
_APPLICATION_SCHEMES = ("file", "app", "foxglove", "lichtblick")
"""The URL schemes of desktop programs that are built from web pages."""


def is_allowed_origin(origin: str | None, extra_origins: Collection[str] = (), host: str = "") -> bool:
    """Return whether a client with an ``Origin`` header may connect.

    A client without such a header is a program, and may connect. So may pages of Foxglove and Lichtblick, and pages
    that this machine serves. A page that another machine opens by this machine's IP address counts as such a page; one
    that it opens by a name does not, because the owner of a name can make it refer to any machine.

    Args:
        origin: the header; None if there is none.
        extra_origins: further origins that may connect; ``*`` means all.
        host: the host and port to which the client has connected; empty if they are not known.
    """
    if origin is None or "*" in extra_origins or origin in extra_origins:
        return True
    try:
        url = urlsplit(origin)
        page_host = (url.hostname or "").lower()
        own_host = urlsplit(f"//{host}").hostname
    except ValueError:
        return False
    if url.scheme in _APPLICATION_SCHEMES:
        return True
    if url.scheme not in ("http", "https"):
        return False
    address = _parse_address(page_host)
    if page_host == "localhost" or (address is not None and (address.is_loopback or page_host == own_host)):
        return True
    return url.scheme == "https" and any(page_host == name or page_host.endswith(f".{name}") for name in _APPLICATIONS)


def _parse_address(host: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    """Return the IP address that a host is, or None for a name."""
    try:
        return ipaddress.ip_address(host)
    except ValueError:
        return None
