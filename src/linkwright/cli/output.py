"""Writing the files that commands produce."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError

if TYPE_CHECKING:
    from pathlib import Path


def write_output(path: Path, content: str | bytes) -> None:
    """Write a result file, making its folder.

    Raises:
        LinkwrightError: CLI201 when it cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
    except OSError as error:
        raise LinkwrightError(
            Diagnostic(
                "CLI201",
                f"cannot write '{path}': {error.strerror or error}",
                hint="name a file in a folder that you may write to",
            )
        ) from None
