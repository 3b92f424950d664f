"""Install models from any source, verified and complete, or not at all."""

from __future__ import annotations

import os
import shutil
import urllib.parse
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.model_files.archives import unpack
from linkwright.model_files.downloads import Progress, fetch, write_error
from linkwright.model_files.installed import models_folder, verify, verify_checksum
from linkwright.model_files.table import ModelEntry


def install(entry: ModelEntry, source: str | None, folder: Path | None, progress: Progress) -> Path:
    """Download a model or read it from a local source, verify it, and install it.

    An installed version of the model is replaced.

    Args:
        entry: the model.
        source: None for the publisher's address. Otherwise, the address of a mirror's file or folder, a downloaded
            file, or a folder with this file or with the unpacked model.
        folder: the folder of models; `models_folder` if omitted.
        progress: the function that receives the progress of the download.

    Returns:
        The folder of the model, or the file of a model that is a single file.

    Raises:
        LinkwrightError: MODEL103 if the model cannot be downloaded, MODEL104 if the file differs, MODEL105 if it is not
            a model file, MODEL106 if it cannot be written, or MODEL107 if the source does not have the model.
    """
    target = folder or models_folder()
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise write_error(target, error) from None
    if source is not None and not _is_address(source):
        return _install_local(entry, Path(source).expanduser(), target)
    part_file = target / f".{entry.file_name}.part"
    is_resumed = part_file.exists()
    address = _resolve_file_address(entry, source or entry.address)
    fetch(entry, address, part_file, progress)
    try:
        path = _install_file(entry, part_file, target, address)
    except LinkwrightError as error:
        if error.diagnostics[0].code != "MODEL106":
            part_file.unlink(missing_ok=True)  # Resuming it would not fix it.
        if not is_resumed or error.diagnostics[0].code == "MODEL106":
            raise
        fetch(entry, address, part_file, progress)  # The existing part may be of another file.
        try:
            path = _install_file(entry, part_file, target, address)
        except LinkwrightError:
            part_file.unlink(missing_ok=True)
            raise
    part_file.unlink(missing_ok=True)
    return path


def _is_address(source: str) -> bool:
    return urllib.parse.urlsplit(source).scheme in ("http", "https")


def _resolve_file_address(entry: ModelEntry, address: str) -> str:
    """Return the address of the model's file, given this address or the address of its folder."""
    if urllib.parse.urlsplit(address).path.endswith(entry.file_name):
        return address
    return f"{address.rstrip('/')}/{entry.file_name}"


def _install_local(entry: ModelEntry, source: Path, target: Path) -> Path:
    if source.is_file():
        return _install_file(entry, source, target)
    if source.is_dir():
        packed_file = source / entry.file_name
        if packed_file.is_file():
            return _install_file(entry, packed_file, target)
        if entry.folder:
            first_file = next(iter(entry.files))
            for unpacked_folder in (source / entry.folder, source):
                if (unpacked_folder / first_file).is_file():
                    return _install_folder(entry, unpacked_folder, target)
    message = phrase("'{path}' does not contain the model '{name}'", path=source, name=entry.name)
    hint = phrase("pass the file {file}, or a folder that contains it", file=entry.file_name)
    raise LinkwrightError(Diagnostic("MODEL107", message, hint=hint))


def _install_file(entry: ModelEntry, file: Path, target: Path, origin: str | None = None) -> Path:
    """Verify and install a downloaded file."""
    verify_checksum(entry, file, entry.sha256, origin)
    with _create_draft(entry, target) as draft:
        if entry.folder:
            unpack(entry, file, draft, origin)
            verify(entry, draft)
        else:
            _copy(file, draft)
    return target / entry.installed_name


def _install_folder(entry: ModelEntry, folder: Path, target: Path) -> Path:
    """Verify and install an unpacked model."""
    verify(entry, folder)
    with _create_draft(entry, target) as draft:
        for name in entry.files:
            with suppress(FileExistsError):
                (draft / name).parent.mkdir(parents=True)
            _copy(folder / name, draft / name)
    return target / entry.installed_name


@contextmanager
def _create_draft(entry: ModelEntry, target: Path) -> Iterator[Path]:
    """Provide a temporary path for the model, to be renamed on success and deleted on error."""
    installed_path = target / entry.installed_name
    draft = target / f".{entry.installed_name}.draft-{os.urandom(4).hex()}"
    previous = target / f".{entry.installed_name}.former-{os.urandom(4).hex()}"
    try:
        yield draft
        with suppress(FileNotFoundError):
            installed_path.replace(previous)
        try:
            draft.replace(installed_path)
        except OSError:
            with suppress(FileNotFoundError):
                previous.replace(installed_path)
            raise
    except OSError as error:
        raise write_error(installed_path, error) from None
    finally:
        for leftover in (draft, previous):
            _discard(leftover)


def _discard(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)


def _copy(source: Path, target: Path) -> None:
    try:
        shutil.copyfile(source, target)
    except OSError as error:
        raise write_error(target, error) from None
