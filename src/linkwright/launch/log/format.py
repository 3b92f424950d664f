"""How lines of the launcher look: ROS's two named formats, or one of the user's own."""

from __future__ import annotations

import time
from collections.abc import Callable

FORMATS = {
    "default": "[{levelname}] [{name}]: {msg}",
    "default_with_timestamp": "{created:.7f} [{levelname}] [{name}]: {msg}",
}
FILE_FORMATS = {"default": FORMATS["default_with_timestamp"]}

Line = Callable[[str, str, str], str]
"""Makes a line of a level, a logger's name and a text."""


def line_format(wanted: str | None, named: dict[str, str]) -> Line:
    """What makes lines.

    Args:
        wanted: a name of `named`, or a format with the fields of Python's log records in braces; None for the default.
        named: formats by name.

    Returns:
        The maker of lines. A format that cannot be filled gives the default one's lines.
    """
    template = named.get(wanted or "default", wanted or "")

    def line(level: str, name: str, text: str) -> str:
        created = time.time()
        fields = {
            "levelname": level,
            "name": name,
            "msg": text,
            "message": text,
            "created": created,
            "msecs": (created % 1.0) * 1000.0,
            "asctime": time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(created)),
        }
        try:
            return template.format(**fields)
        except (LookupError, ValueError):
            return named["default"].format(**fields)

    return line
