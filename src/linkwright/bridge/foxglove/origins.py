"""Decides which web pages may connect.

Any page that a user opens could otherwise connect to a server of this machine.
"""

from __future__ import annotations

import ipaddress
from collections.abc import Collection
from urllib.parse import urlsplit

_APPLICATIONS = ("foxglove.dev", "lichtblick-suite.github.io")
_SCHEMES_OF_PROGRAMS = ("file", "app", "foxglove", "lichtblick")
"""Desktop programs built from web pages."""


def is_allowed_origin(origin: str | None, more: Collection[str] = ()) -> bool:
    """Return whether a client with an ``Origin`` header may connect.

    A client without such a header is a program, and may connect. So may pages of Foxglove and Lichtblick, and pages
    that this machine serves.

    Args:
        origin: the header; None if there is none.
        more: further origins that may connect; ``*`` means all.
    """
    if origin is None or "*" in more or origin in more:
        return True
    try:
        parts = urlsplit(origin)
        host = (parts.hostname or "").lower()
    except ValueError:
        return False
    if parts.scheme in _SCHEMES_OF_PROGRAMS:
        return True
    if parts.scheme not in ("http", "https"):
        return False
    if host == "localhost" or _is_loopback(host):
        return True
    return parts.scheme == "https" and any(host == name or host.endswith(f".{name}") for name in _APPLICATIONS)


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False
