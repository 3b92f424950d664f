"""Putting a model in its place, wherever it comes from: whole and checked, or not at all."""

from __future__ import annotations

import os
import shutil
import urllib.parse
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.model_files.archives import unpack
from linkwright.model_files.fetching import Progress, cannot_write, fetch
from linkwright.model_files.installed import check_sum, checked, models_folder
from linkwright.model_files.table import ModelEntry


def install(entry: ModelEntry, source: str | None, folder: Path | None, progress: Progress) -> Path:
    """Get a model, check it, and put it in its place; one that was there is replaced.

    Args:
        entry: the model.
        source: None for the makers' address; else a mirror's address, of the file or of the folder with it; a file as
            it would be fetched; a folder that holds this file, or the model unpacked, or is it.
        folder: where to put it; `models_folder` when left out.
        progress: is told how far it has come when it is fetched.

    Returns:
        Its folder, or its file where it is one file.

    Raises:
        LinkwrightError: MODEL103 it cannot be fetched, MODEL104 it is another file, MODEL105 it is not a model's,
            MODEL106 it cannot be written, MODEL107 the source has no such model.
    """
    target = folder or models_folder()
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(target, error) from None
    if source is not None and not _is_address(source):
        return _install_local(entry, Path(source).expanduser(), target)
    part = target / f".{entry.file_name}.part"
    resumed = part.exists()
    address = _file_of(entry, source or entry.address)
    fetch(entry, address, part, progress)
    try:
        place = _install_file(entry, part, target, address)
    except LinkwrightError as error:
        if error.diagnostics[0].code != "MODEL106":
            part.unlink(missing_ok=True)  # going on with it would not mend it
        if not resumed or error.diagnostics[0].code == "MODEL106":
            raise
        fetch(entry, address, part, progress)  # the beginning may have been another file's
        try:
            place = _install_file(entry, part, target, address)
        except LinkwrightError:
            part.unlink(missing_ok=True)
            raise
    part.unlink(missing_ok=True)
    return place


def _is_address(source: str) -> bool:
    return urllib.parse.urlsplit(source).scheme in ("http", "https")


def _file_of(entry: ModelEntry, address: str) -> str:
    """The address of the file, where that of a folder may be given."""
    if urllib.parse.urlsplit(address).path.endswith(entry.file_name):
        return address
    return f"{address.rstrip('/')}/{entry.file_name}"


def _install_local(entry: ModelEntry, source: Path, target: Path) -> Path:
    if source.is_file():
        return _install_file(entry, source, target)
    if source.is_dir():
        packed = source / entry.file_name
        if packed.is_file():
            return _install_file(entry, packed, target)
        if entry.folder:
            first = next(iter(entry.files))
            for unpacked in (source / entry.folder, source):
                if (unpacked / first).is_file():
                    return _install_folder(entry, unpacked, target)
    message = phrase("'{path}' holds no model '{name}'", path=source, name=entry.name)
    hint = phrase("it is a folder with {file}, or this file", file=entry.file_name)
    raise LinkwrightError(Diagnostic("MODEL107", message, hint=hint))


def _install_file(entry: ModelEntry, file: Path, target: Path, origin: str | None = None) -> Path:
    """Put a file as it is fetched in its place."""
    check_sum(entry, file, entry.sha256, origin)
    with _draft(entry, target) as draft:
        if entry.folder:
            unpack(entry, file, draft, origin)
            checked(entry, draft)
        else:
            _copy(file, draft)
    return target / entry.place


def _install_folder(entry: ModelEntry, folder: Path, target: Path) -> Path:
    """Put a model that is unpacked in its place."""
    checked(entry, folder)
    with _draft(entry, target) as draft:
        for name in entry.files:
            with suppress(FileExistsError):
                (draft / name).parent.mkdir(parents=True)
            _copy(folder / name, draft / name)
    return target / entry.place


@contextmanager
def _draft(entry: ModelEntry, target: Path) -> Iterator[Path]:
    """A place for the model to be made in: it becomes its own when nothing goes wrong, and goes when something does."""
    place = target / entry.place
    draft = target / f".{entry.place}.draft-{os.urandom(4).hex()}"
    former = target / f".{entry.place}.former-{os.urandom(4).hex()}"
    try:
        yield draft
        with suppress(FileNotFoundError):
            place.replace(former)
        try:
            draft.replace(place)
        except OSError:
            with suppress(FileNotFoundError):
                former.replace(place)
            raise
    except OSError as error:
        raise cannot_write(place, error) from None
    finally:
        for left in (draft, former):
            _discard(left)


def _discard(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)


def _copy(source: Path, target: Path) -> None:
    try:
        shutil.copyfile(source, target)
    except OSError as error:
        raise cannot_write(target, error) from None
