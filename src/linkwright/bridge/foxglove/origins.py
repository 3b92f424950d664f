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


def is_allowed_origin(origin: str | None, extra_origins: Collection[str] = ()) -> bool:
    """Return whether a client with an ``Origin`` header may connect.

    A client without such a header is a program, and may connect. So may pages of Foxglove and Lichtblick, and pages
    that this machine serves.

    Args:
        origin: the header; None if there is none.
        extra_origins: further origins that may connect; ``*`` means all.
    """
    if origin is None or "*" in extra_origins or origin in extra_origins:
        return True
    try:
        url = urlsplit(origin)
        host = (url.hostname or "").lower()
    except ValueError:
        return False
    if url.scheme in _APPLICATION_SCHEMES:
        return True
    if url.scheme not in ("http", "https"):
        return False
    if host == "localhost" or _is_loopback(host):
        return True
    return url.scheme == "https" and any(host == name or host.endswith(f".{name}") for name in _APPLICATIONS)


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False
