"""Extraction of a model from an archive, limited to the files that the table names."""

from __future__ import annotations

import zipfile
import zlib
from collections.abc import Generator, Iterator
from contextlib import closing
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, phrase
from linkwright.model_files.fetching import cannot_write
from linkwright.model_files.installed import by_hand
from linkwright.model_files.table import ModelEntry

_MOST_BYTES = 1 << 29
"""The maximum size of an unpacked model; those in the table have a tenth of it."""

_AT_ONCE = 1 << 20


def unpack(entry: ModelEntry, archive: Path, target: Path, origin: str | None = None) -> None:
    """Extract the files of a model from a ZIP archive; paths in the archive are never used for writing.

    Args:
        entry: the model.
        archive: the file.
        target: the folder to create and write them to.
        origin: the source of the download, for messages to users that do not know its path.

    Raises:
        LinkwrightError: MODEL105 it is not such an archive, lacks a file or is too large; MODEL106 it cannot be
            written.
    """
    shown = origin or str(archive)
    try:
        with zipfile.ZipFile(archive) as opened:
            left = _MOST_BYTES
            for name in entry.files:
                with closing(_blocks(opened, f"{entry.folder}/{name}")) as blocks:
                    left -= _write(target / name, blocks, left, entry, shown)
    except KeyError as error:
        raise _unusable(entry, shown, phrase("it does not contain '{file}'", file=str(error.args[0]))) from None
    except (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, NotImplementedError, OSError) as error:
        raise _unusable(entry, shown, foreign(error)) from None


def _blocks(opened: zipfile.ZipFile, name: str) -> Generator[bytes, None, None]:
    try:
        found = opened.getinfo(name)
    except KeyError:
        raise KeyError(name) from None
    with opened.open(found) as member:
        while block := member.read(_AT_ONCE):
            yield block


def _write(path: Path, blocks: Iterator[bytes], most: int, entry: ModelEntry, shown: str) -> int:
    """Write a file and return its size."""
    size = 0
    _append(path, b"")
    for block in blocks:
        size += len(block)
        if size > most:
            raise _unusable(entry, shown, phrase("its contents are too large"))
        _append(path, block)
    return size


def _append(path: Path, block: bytes) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("ab") as file:
            file.write(block)
    except OSError as error:
        raise cannot_write(path, error) from None


def _unusable(entry: ModelEntry, shown: str, problem: Phrase) -> LinkwrightError:
    message = phrase(
        "'{path}' is not an archive of the model '{name}': {problem}", path=shown, name=entry.name, problem=problem
    )
    return LinkwrightError(Diagnostic("MODEL105", message, hint=by_hand(entry)))
