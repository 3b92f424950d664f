"""Read the metadata in a wheel."""

from __future__ import annotations

import zipfile
from email.message import Message
from email.parser import Parser
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase


def read_metadata(wheel: Path) -> Message:
    """Return the metadata of a wheel: its name, version and requirements.

    Raises:
        LinkwrightError: LEARN305 if the file is not a wheel.
    """
    try:
        with zipfile.ZipFile(wheel) as archive:
            (name,) = (
                entry for entry in archive.namelist() if entry.endswith(".dist-info/METADATA") and entry.count("/") == 1
            )
            return Parser().parsestr(archive.read(name).decode("utf-8"))
    except (zipfile.BadZipFile, OSError, ValueError) as error:
        message = phrase("'{path}' is not a wheel: {reason}", path=display_path(wheel), reason=foreign(error))
        raise LinkwrightError(Diagnostic("LEARN305", message)) from None
