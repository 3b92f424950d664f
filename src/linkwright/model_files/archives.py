"""Extract a model from an archive, limited to the files that the table names."""

from __future__ import annotations

import zipfile
import zlib
from collections.abc import Generator, Iterator
from contextlib import closing
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, phrase
from linkwright.model_files.downloads import write_error
from linkwright.model_files.installed import manual_download_hint
from linkwright.model_files.table import ModelEntry

_MAX_BYTES = 1 << 29
"""The maximum size of an unpacked model in bytes. The models in the table need a tenth of it."""

_BLOCK_BYTES = 1 << 20


def unpack(entry: ModelEntry, archive: Path, target: Path, origin: str | None = None) -> None:
    """Extract the files of a model from a ZIP archive.

    Paths in the archive are never used for writing.

    Args:
        entry: the model.
        archive: the file.
        target: the folder to create for the extracted files.
        origin: the source of the download, named in messages in place of the archive's temporary path.

    Raises:
        LinkwrightError: MODEL105 if it is not such an archive, lacks a file or is too large, or MODEL106 if a file
            cannot be written.
    """
    shown_path = origin or str(archive)
    try:
        with zipfile.ZipFile(archive) as zip_file:
            remaining_bytes = _MAX_BYTES
            for name in entry.files:
                with closing(_read_blocks(zip_file, f"{entry.folder}/{name}")) as blocks:
                    remaining_bytes -= _write_file(target / name, blocks, remaining_bytes, entry, shown_path)
    except KeyError as error:
        raise _unusable_archive_error(
            entry, shown_path, phrase("it does not contain '{file}'", file=str(error.args[0]))
        ) from None
    except (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, NotImplementedError, OSError) as error:
        raise _unusable_archive_error(entry, shown_path, foreign(error)) from None


def _read_blocks(zip_file: zipfile.ZipFile, name: str) -> Generator[bytes, None, None]:
    try:
        info = zip_file.getinfo(name)
    except KeyError:
        raise KeyError(name) from None
    with zip_file.open(info) as member:
        while block := member.read(_BLOCK_BYTES):
            yield block


def _write_file(path: Path, blocks: Iterator[bytes], max_bytes: int, entry: ModelEntry, shown_path: str) -> int:
    """Write a file and return its size."""
    size = 0
    _append(path, b"")
    for block in blocks:
        size += len(block)
        if size > max_bytes:
            raise _unusable_archive_error(entry, shown_path, phrase("its contents are too large"))
        _append(path, block)
    return size


def _append(path: Path, block: bytes) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("ab") as file:
            file.write(block)
    except OSError as error:
        raise write_error(path, error) from None


def _unusable_archive_error(entry: ModelEntry, shown_path: str, problem: Phrase) -> LinkwrightError:
    message = phrase(
        "'{path}' is not an archive of the model '{name}': {problem}", path=shown_path, name=entry.name, problem=problem
    )
    return LinkwrightError(Diagnostic("MODEL105", message, hint=manual_download_hint(entry)))
