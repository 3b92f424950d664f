"""Installation of models from any source: verified and complete, or not at all."""

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
    """Get, verify and install a model, replacing an installed one.

    Args:
        entry: the model.
        source: None for the publisher's address; else the address of a mirror's file or folder; the file to download;
            or a folder with this file or with the unpacked model.
        folder: the folder of models; `models_folder` if omitted.
        progress: receives the progress of the download.

    Returns:
        Its folder, or its file if it is a single file.

    Raises:
        LinkwrightError: MODEL103 it cannot be downloaded, MODEL104 the file differs, MODEL105 it is not a model file,
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
            part.unlink(missing_ok=True)  # Resuming it would not fix it.
        if not resumed or error.diagnostics[0].code == "MODEL106":
            raise
        fetch(entry, address, part, progress)  # The existing part may be of another file.
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
    """Return the address of the file; the address of its folder is accepted, too."""
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
    message = phrase("'{path}' does not contain the model '{name}'", path=source, name=entry.name)
    hint = phrase("give a folder that contains {file}, or that file", file=entry.file_name)
    raise LinkwrightError(Diagnostic("MODEL107", message, hint=hint))


def _install_file(entry: ModelEntry, file: Path, target: Path, origin: str | None = None) -> Path:
    """Install a downloaded file."""
    check_sum(entry, file, entry.sha256, origin)
    with _draft(entry, target) as draft:
        if entry.folder:
            unpack(entry, file, draft, origin)
            checked(entry, draft)
        else:
            _copy(file, draft)
    return target / entry.place


def _install_folder(entry: ModelEntry, folder: Path, target: Path) -> Path:
    """Install an unpacked model."""
    checked(entry, folder)
    with _draft(entry, target) as draft:
        for name in entry.files:
            with suppress(FileExistsError):
                (draft / name).parent.mkdir(parents=True)
            _copy(folder / name, draft / name)
    return target / entry.place


@contextmanager
def _draft(entry: ModelEntry, target: Path) -> Iterator[Path]:
    """Provide a temporary path for the model, which is renamed on success and deleted on an error."""
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
