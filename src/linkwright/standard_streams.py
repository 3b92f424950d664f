"""Standard streams that take every text, whichever code page or locale the system has.

Descriptions are UTF-8 and may name a link in any script, and messages may be Chinese; a Windows of the West writes into
files and pipes by code page 1252. It imports little, because short commands load it.
"""

from __future__ import annotations

import io
import os
import sys


def take_any_text() -> None:
    """Have standard streams take every text, where they do not.

    Files and pipes get and give UTF-8, as files of descriptions are; so does Python itself from 3.15 on (PEP 686). What
    a terminal has no letters for is written as its number, as it is where ``PYTHONIOENCODING`` names an encoding.
    """
    chosen = bool(os.environ.get("PYTHONIOENCODING"))
    for stream in (sys.stdin, sys.stdout, sys.stderr):
        if not isinstance(stream, io.TextIOWrapper) or stream.encoding.lower().replace("-", "") == "utf8":
            continue
        if not chosen and not stream.isatty():
            stream.reconfigure(encoding="utf-8", errors=stream.errors)
        elif stream is not sys.stdin:
            stream.reconfigure(errors="backslashreplace")
