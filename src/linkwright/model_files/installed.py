"""Installed models: their locations, verification and removal."""

from __future__ import annotations

import hashlib
import shutil
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, foreign, phrase
from linkwright.files.user_folders import data_folder
from linkwright.model_files.table import ModelEntry

_BLOCK_BYTES = 1 << 20


def models_folder() -> Path:
    """Return the folder ``linkwright/models`` in ``XDG_DATA_HOME`` or ``~/.local/share``.

    The folder is not a cache, because an offline user cannot download models again.
    """
    return data_folder() / "models"


def is_installed(entry: ModelEntry, folder: Path | None = None) -> bool:
    """Return whether a model is installed.

    An installed model was verified at its installation.

    Args:
        entry: the model.
        folder: the folder of models; `models_folder` if omitted.
    """
    return ((folder or models_folder()) / entry.installed_name).exists()


def find_model(entry: ModelEntry) -> Path:
    """Return the folder or file of an installed model.

    Raises:
        LinkwrightError: MODEL102 if the model is not installed.
    """
    if not is_installed(entry):
        message = phrase("the model '{name}' is not downloaded", name=entry.name)
        hint = phrase(
            "run `linkwright models get {name}`, about {megabytes} MB", name=entry.name, megabytes=entry.megabytes
        )
        raise LinkwrightError(Diagnostic("MODEL102", message, hint=hint))
    return models_folder() / entry.installed_name


def remove(entry: ModelEntry) -> Path:
    """Remove an installed model, and return its path.

    Raises:
        LinkwrightError: MODEL102 if the model is not installed, or MODEL106 if it cannot be removed.
    """
    path = find_model(entry)
    try:
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink()
    except OSError as error:
        message = phrase("cannot remove '{path}': {reason}", path=path, reason=foreign(error.strerror or error))
        raise LinkwrightError(Diagnostic("MODEL106", message)) from None
    return path


def manual_download_hint(entry: ModelEntry) -> Phrase:
    """Return a hint on how to install a model from a file downloaded with a browser."""
    return phrase(
        "download {address} with a browser, then run `linkwright models get {name} --from FILE`",
        address=entry.address,
        name=entry.name,
    )


def verify(entry: ModelEntry, path: Path) -> None:
    """Verify the checksums of a model.

    Args:
        entry: the model.
        path: the folder or file of the model.

    Raises:
        LinkwrightError: MODEL104 if a file differs, or MODEL105 if a file is missing.
    """
    if not entry.folder:
        verify_checksum(entry, path, entry.sha256)
        return
    for name, expected in entry.files.items():
        verify_checksum(entry, path / name, expected)


def verify_checksum(entry: ModelEntry, path: Path, expected: str | None, origin: str | None = None) -> None:
    """Verify the checksum of a file of a model.

    Args:
        entry: the model.
        path: the file.
        expected: the SHA-256 of the file, or None to verify nothing.
        origin: the source of the download, named in messages in place of the file's temporary path.

    Raises:
        LinkwrightError: MODEL104 if the checksum differs, or MODEL105 if the file cannot be read.
    """
    if expected is None:
        return
    digest = hashlib.sha256()
    try:
        with path.open("rb") as file:
            while block := file.read(_BLOCK_BYTES):
                digest.update(block)
    except OSError as error:
        message = phrase(
            "file '{path}' of the model '{name}' cannot be read: {reason}",
            name=entry.name,
            path=path,
            reason=foreign(error.strerror or error),
        )
        raise LinkwrightError(Diagnostic("MODEL105", message, hint=manual_download_hint(entry))) from None
    if digest.hexdigest() != expected:
        message = phrase("'{path}' is not the right file for the model '{name}'", path=origin or path, name=entry.name)
        checksum_note = phrase(
            "its SHA-256 is {actual}, but {expected} is expected", actual=digest.hexdigest(), expected=expected
        )
        raise LinkwrightError(
            Diagnostic("MODEL104", message, notes=(Note(checksum_note),), hint=manual_download_hint(entry))
        )
