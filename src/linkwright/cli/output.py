"""The result files of commands."""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path


def write_output(path: Path, content: str | bytes) -> None:
    """Write a result file atomically, and create its folder if necessary.

    A byte of a file's name that is not UTF-8 is written as an escape sequence.

    Raises:
        LinkwrightError: CLI201, the file cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole_file(path, content.encode("utf-8", "backslashreplace") if isinstance(content, str) else content)
    except OSError as error:
        raise write_error(path, error) from None


def write_error(path: Path, error: OSError) -> LinkwrightError:
    """Return the error for a result file that cannot be written (CLI201)."""
    message = phrase("cannot write '{path}': {reason}", path=path, reason=foreign(error.strerror or error))
    hint = phrase("choose a file in a writable folder")
    return LinkwrightError(Diagnostic("CLI201", message, hint=hint))
