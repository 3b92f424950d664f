"""The logger that launch files ask ``launch.logging`` for."""

from __future__ import annotations

import logging
import sys


class _LaunchFormat(logging.Handler):
    """Writes records as launch lines on stderr: ``[INFO] [name]: text``."""

    def emit(self, record: logging.LogRecord) -> None:
        """Write a record."""
        name = record.name.removeprefix(_ROOT + ".")
        print(f"[{record.levelname}] [{name}]: {record.getMessage()}", file=sys.stderr, flush=True)


_ROOT = "linkwright_launch"


def get_logger(name: str | None = None) -> logging.Logger:
    """A logger whose lines look like those of the launcher."""
    root = logging.getLogger(_ROOT)
    if not root.handlers:
        root.addHandler(_LaunchFormat())
        root.setLevel(logging.INFO)
        root.propagate = False
    return root.getChild(name or "launch")
