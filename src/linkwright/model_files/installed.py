"""Installed models: their locations, verification and removal."""

from __future__ import annotations

import hashlib
import shutil
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, foreign, phrase
from linkwright.files.user_folders import data_folder
from linkwright.model_files.table import ModelEntry

_AT_ONCE = 1 << 20


def models_folder() -> Path:
    """Return the folder of models: ``XDG_DATA_HOME/linkwright/models`` or ``~/.local/share/linkwright/models``.

    It is not a cache: an offline user cannot download models again.
    """
    return data_folder() / "models"


def is_installed(entry: ModelEntry, folder: Path | None = None) -> bool:
    """Return whether a model is installed; it was verified at its installation.

    Args:
        entry: the model.
        folder: the folder of models; `models_folder` if omitted.
    """
    return ((folder or models_folder()) / entry.place).exists()


def find_model(entry: ModelEntry) -> Path:
    """Return the folder or file of an installed model.

    Raises:
        LinkwrightError: MODEL102 it is not installed.
    """
    if not is_installed(entry):
        message = phrase("the model '{name}' is not downloaded", name=entry.name)
        hint = phrase(
            "run `linkwright models get {name}`, about {megabytes} MB", name=entry.name, megabytes=entry.megabytes
        )
        raise LinkwrightError(Diagnostic("MODEL102", message, hint=hint))
    return models_folder() / entry.place


def remove(entry: ModelEntry) -> Path:
    """Remove an installed model, and return its path.

    Raises:
        LinkwrightError: MODEL102 it is not installed, MODEL106 it cannot be removed.
    """
    place = find_model(entry)
    try:
        if place.is_dir() and not place.is_symlink():
            shutil.rmtree(place)
        else:
            place.unlink()
    except OSError as error:
        message = phrase("cannot remove '{path}': {reason}", path=place, reason=foreign(error.strerror or error))
        raise LinkwrightError(Diagnostic("MODEL106", message)) from None
    return place


def by_hand(entry: ModelEntry) -> Phrase:
    """Return a hint on how to get a model without downloading it with Linkwright."""
    return phrase(
        "download {address} with a browser, then run `linkwright models get {name} --from FILE`",
        address=entry.address,
        name=entry.name,
    )


def checked(entry: ModelEntry, place: Path) -> None:
    """Verify the checksums of a model.

    Args:
        entry: the model.
        place: its folder or file.

    Raises:
        LinkwrightError: MODEL104 a file differs, MODEL105 a file is missing.
    """
    if not entry.folder:
        check_sum(entry, place, entry.sha256)
        return
    for name, expected in entry.files.items():
        check_sum(entry, place / name, expected)


def check_sum(entry: ModelEntry, path: Path, expected: str | None, origin: str | None = None) -> None:
    """Verify the checksum of a file of a model.

    Args:
        entry: the model.
        path: the file.
        expected: its SHA-256; None if it is not known.
        origin: the source of the download, for messages to users that do not know its path.

    Raises:
        LinkwrightError: MODEL104 it differs, MODEL105 it cannot be read.
    """
    if expected is None:
        return
    found = hashlib.sha256()
    try:
        with path.open("rb") as file:
            while block := file.read(_AT_ONCE):
                found.update(block)
    except OSError as error:
        message = phrase(
            "file '{path}' of the model '{name}' cannot be read: {reason}",
            name=entry.name,
            path=path,
            reason=foreign(error.strerror or error),
        )
        raise LinkwrightError(Diagnostic("MODEL105", message, hint=by_hand(entry))) from None
    if found.hexdigest() != expected:
        message = phrase("'{path}' is not the right file for the model '{name}'", path=origin or path, name=entry.name)
        sums = phrase("its SHA-256 is {found}; expected {expected}", found=found.hexdigest(), expected=expected)
        raise LinkwrightError(Diagnostic("MODEL104", message, notes=(Note(sums),), hint=by_hand(entry)))
