"""The bytes of a configuration file: read with their form, written back in it, never half."""

from __future__ import annotations

import codecs
import os
import secrets
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError

MAXIMUM_SIZE = 16 * 1024 * 1024
"""Largest file read, bytes; those that RViz writes have some ten thousand."""


@dataclass(frozen=True, slots=True)
class FileForm:
    """How a file says its text.

    Attributes:
        mark: whether it begins with a byte order mark.
        newline: what ends its lines.
    """

    mark: bool = False
    newline: str = "\n"


@dataclass(frozen=True, slots=True)
class FileState:
    """By what a file is known to be the one that was read: nanoseconds of its last change, and bytes."""

    modified: int
    size: int


def read(path: Path) -> tuple[str, FileForm]:
    """The text of a file, with its own line ends, and its form.

    Raises:
        LinkwrightError: RVIZ101, it cannot be read.
    """
    try:
        with path.open("rb") as file:
            content = file.read(MAXIMUM_SIZE + 1)
    except OSError as error:
        hint = "name a .rviz file after '-d'" if isinstance(error, FileNotFoundError) else None
        message = f"cannot read the RViz configuration '{path}': {error.strerror or error}"
        raise LinkwrightError(Diagnostic("RVIZ101", message, hint=hint)) from None
    if len(content) > MAXIMUM_SIZE:
        message = f"the RViz configuration '{path}' is larger than {MAXIMUM_SIZE // 2**20} MiB"
        raise LinkwrightError(Diagnostic("RVIZ101", message))
    mark = content.startswith(codecs.BOM_UTF8)
    try:
        text = content.removeprefix(codecs.BOM_UTF8).decode("utf-8")
    except UnicodeDecodeError:
        message = f"the RViz configuration '{path}' is not a text in UTF-8"
        raise LinkwrightError(Diagnostic("RVIZ101", message)) from None
    return text, FileForm(mark, "\r\n" if "\r\n" in text else "\n")


def write(path: Path, text: str, form: FileForm) -> None:
    """Write a text to a file, whole or not at all wherever the folder allows that.

    Raises:
        LinkwrightError: RVIZ104, it cannot be written.
    """
    content = (codecs.BOM_UTF8 if form.mark else b"") + text.encode("utf-8")
    try:
        target = Path(os.path.realpath(path))  # a link stays one
        try:
            _replace(target, content)
        except OSError:
            # The folder may not be written to, or the file is a mount of its own, as Docker makes them.
            if not target.is_file():
                raise
            target.write_bytes(content)
    except OSError as error:
        message = f"cannot write the RViz configuration '{path}': {error.strerror or error}"
        raise LinkwrightError(Diagnostic("RVIZ104", message)) from None


def state_of(path: Path) -> FileState | None:
    """What a file is known by now; None when there is none."""
    try:
        facts = path.stat()
    except OSError:
        return None
    return FileState(facts.st_mtime_ns, facts.st_size)


def _replace(target: Path, content: bytes) -> None:
    draft = target.with_name(f".{target.name}.{secrets.token_hex(4)}")
    descriptor = os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        with suppress(FileNotFoundError):
            draft.chmod(target.stat().st_mode & 0o777)
        draft.replace(target)
    except BaseException:
        with suppress(OSError):
            draft.unlink()
        raise
