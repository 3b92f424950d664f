"""Read and write configuration files.

The encoding and line endings are preserved, and a file is never left half written.
"""

from __future__ import annotations

import codecs
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.files.input_files import read_file
from linkwright.files.whole_files import write_whole_file

MAX_SIZE = 16 * 1024 * 1024
"""The largest file that is read, in bytes. Files that RViz writes have about ten thousand bytes."""


@dataclass(frozen=True, slots=True)
class FileForm:
    """The byte order mark and the line endings of a file.

    Attributes:
        has_byte_order_mark: whether the file begins with a byte order mark.
        newline: the line ending.
    """

    has_byte_order_mark: bool = False
    newline: str = "\n"


@dataclass(frozen=True, slots=True)
class FileState:
    """The modification time (ns) and size (bytes) of a file, used to detect later changes."""

    modified_ns: int
    size: int


def read(path: Path) -> tuple[str, FileForm]:
    """Return the text of a file, with its line endings unchanged, and the file's form.

    Raises:
        LinkwrightError: RVIZ101, the file cannot be read, is too large, or is not UTF-8.
    """
    try:
        content = read_file(path, MAX_SIZE + 1)
    except OSError as error:
        hint = phrase("give the path of a .rviz file after '-d'") if isinstance(error, FileNotFoundError) else None
        message = phrase(
            "cannot read the RViz configuration '{path}': {reason}",
            path=path,
            reason=foreign(error.strerror or error),
        )
        raise LinkwrightError(Diagnostic("RVIZ101", message, hint=hint)) from None
    if len(content) > MAX_SIZE:
        message = phrase(
            "the RViz configuration '{path}' is larger than {maximum_size} MiB",
            path=path,
            maximum_size=MAX_SIZE // 2**20,
        )
        raise LinkwrightError(Diagnostic("RVIZ101", message))
    has_byte_order_mark = content.startswith(codecs.BOM_UTF8)
    try:
        text = content.removeprefix(codecs.BOM_UTF8).decode("utf-8")
    except UnicodeDecodeError:
        message = phrase("the RViz configuration '{path}' is not encoded in UTF-8", path=path)
        raise LinkwrightError(Diagnostic("RVIZ101", message)) from None
    return text, FileForm(has_byte_order_mark, "\r\n" if "\r\n" in text else "\n")


def write(path: Path, text: str, form: FileForm) -> None:
    """Write text to a file, completely or not at all.

    Raises:
        LinkwrightError: RVIZ104, the file cannot be written.
    """
    content = (codecs.BOM_UTF8 if form.has_byte_order_mark else b"") + text.encode("utf-8")
    try:
        write_whole_file(path, content)
    except OSError as error:
        message = phrase(
            "cannot write the RViz configuration '{path}': {reason}",
            path=path,
            reason=foreign(error.strerror or error),
        )
        raise LinkwrightError(Diagnostic("RVIZ104", message)) from None


def get_file_state(path: Path) -> FileState | None:
    """Return the current state of a file, or None if there is no file."""
    try:
        status = path.stat()
    except OSError:
        return None
    return FileState(status.st_mtime_ns, status.st_size)
