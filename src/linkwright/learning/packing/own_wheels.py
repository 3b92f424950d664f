"""The wheels of Linkwright: given, built from a checkout, or repacked from installed files."""

from __future__ import annotations

import base64
import csv
import hashlib
import io
import shutil
import zipfile
from collections.abc import Iterator, Sequence
from importlib import metadata
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name, parse_wheel_filename

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, phrase
from linkwright.diagnostics.installation import find_installation
from linkwright.learning.packing.locked_files import OWN_PACKAGES
from linkwright.learning.packing.pip_runs import build_checkout
from linkwright.learning.packing.wheel_metadata import read_metadata

_FILES_OF_INSTALLER = {"INSTALLER", "REQUESTED", "direct_url.json", "uv_cache.json", "uv_build.json", "RECORD"}
"""The files that an installer adds to the metadata of a distribution, or replaces."""


def add_own_wheels(wheel_files: Sequence[Path], wheels: Path) -> list[Path]:
    """Add the wheels of linkwright-core and linkwright to a folder, and return them.

    Args:
        wheel_files: the files of both wheels; if empty, they are built from the checkout that this Linkwright was
            installed from, or else from the installed files.
        wheels: the folder.

    Raises:
        LinkwrightError: LEARN302 if there are no such wheels, or LEARN303 if the checkout cannot be built.
        OSError: the folder cannot be written.
    """
    if wheel_files:
        paths = [_copy_wheel(path, wheels) for path in wheel_files]
    elif (checkout := _find_checkout()) is not None:
        paths = build_checkout(checkout, wheels)
    else:
        paths = [_build_wheel(name, wheels) for name in OWN_PACKAGES]
    _check_wheels(paths)
    return paths


def _copy_wheel(path: Path, wheels: Path) -> Path:
    try:
        return Path(shutil.copyfile(path, wheels / path.name))
    except FileNotFoundError:
        raise _unusable_wheels_error(phrase("there is no file '{path}'", path=display_path(path))) from None


def _find_checkout() -> Path | None:
    """Return the checkout that the running Linkwright was installed from, if it still exists."""
    location = find_installation().origin.location
    return Path(location) if location and Path(location, "core", "engine_build.py").is_file() else None


def _check_wheels(paths: Sequence[Path]) -> None:
    """Check that the files are the wheels of both distributions in the same version."""
    found = {}
    for path in paths:
        try:
            name, version, _, _ = parse_wheel_filename(path.name)
        except ValueError:
            raise _unusable_wheels_error(phrase("'{path}' is not a wheel", path=display_path(path))) from None
        found[str(name)] = str(version)
    if sorted(found) != sorted(OWN_PACKAGES) or len(set(found.values())) != 1:
        raise _unusable_wheels_error(
            phrase("a pack needs a wheel of linkwright and one of linkwright-core, of the same version")
        )
    for path in paths:
        for text in read_metadata(path).get_all("Requires-Dist") or ():
            if Requirement(text).url:
                raise _unusable_wheels_error(
                    phrase("'{path}' depends on files of the computer that built it", path=path.name)
                )


def _unusable_wheels_error(message: Phrase) -> LinkwrightError:
    hint = phrase("pass the two wheels of a release with --wheel")
    return LinkwrightError(Diagnostic("LEARN302", message, hint=hint))


def _build_wheel(name: str, wheels: Path) -> Path:
    """Build the wheel of an installed distribution from the files that its RECORD lists."""
    try:
        distribution = metadata.distribution(name)
    except metadata.PackageNotFoundError:
        raise _unusable_wheels_error(phrase("'{name}' is not installed as a distribution", name=name)) from None
    if _is_editable(distribution):
        raise _unusable_wheels_error(phrase("'{name}' is installed from a checkout that no longer exists", name=name))
    path = wheels / f"{canonicalize_name(name).replace('-', '_')}-{distribution.version}-py3-none-any.whl"
    draft = path.with_suffix(".draft")
    with zipfile.ZipFile(draft, "w", zipfile.ZIP_DEFLATED) as archive:
        rows = []
        for file, content in _read_recorded_files(distribution):
            archive.writestr(zipfile.ZipInfo(file), content, zipfile.ZIP_DEFLATED)
            rows.append((file, _compute_record_hash(content), str(len(content))))
        record = f"{_find_metadata_folder(distribution)}/RECORD"
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([*rows, (record, "", "")])
        archive.writestr(zipfile.ZipInfo(record), text.getvalue())
    return draft.replace(path)


def _is_editable(distribution: metadata.Distribution) -> bool:
    return '"editable": true' in (distribution.read_text("direct_url.json") or "").replace('":true', '": true')


def _find_metadata_folder(distribution: metadata.Distribution) -> str:
    (record,) = (file for file in distribution.files or () if file.name == "RECORD" and len(file.parts) == 2)
    return record.parts[0]


def _read_recorded_files(distribution: metadata.Distribution) -> Iterator[tuple[str, bytes]]:
    """Yield the files of a wheel with the contents that they had before the installation."""
    folder = _find_metadata_folder(distribution)
    for file in sorted(distribution.files or (), key=str):
        is_made = file.parts[0] == folder and file.name in _FILES_OF_INSTALLER
        if ".." in file.parts or "__pycache__" in file.parts or is_made:
            continue
        try:
            content = Path(str(file.locate())).read_bytes()
        except OSError:
            raise _unusable_wheels_error(
                phrase("the installed file '{path}' cannot be read", path=file.locate())
            ) from None
        if file.hash and f"{file.hash.mode}={file.hash.value}" != _compute_record_hash(content):
            raise _unusable_wheels_error(phrase("the installed file '{path}' was modified", path=file.locate()))
        yield file.as_posix(), content


def _compute_record_hash(content: bytes) -> str:
    """Return a checksum in the format of RECORD."""
    return "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode("ascii")
