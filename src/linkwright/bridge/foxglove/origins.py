"""Decide which web pages may connect, because any page that a user opens can reach addresses of this machine."""

from __future__ import annotations

import ipaddress
from collections.abc import Collection
from urllib.parse import urlsplit

_APPLICATIONS = ("foxglove.dev", "lichtblick-suite.github.io")
_SCHEMES_OF_PROGRAMS = ("file", "app", "foxglove", "lichtblick")
"""Desktop programs built from web pages."""


def is_welcome(origin: str | None, more: Collection[str] = ()) -> bool:
    """Return whether a client with an ``Origin`` header may connect.

    Programs send no such header. Pages of Foxglove and Lichtblick may connect, and so may pages that this machine
    serves.

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
