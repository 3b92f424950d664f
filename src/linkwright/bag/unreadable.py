"""Explain why a file cannot be read as a recording, from its first bytes."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path, PurePath
from typing import NamedTuple

import yaml

from linkwright.bag.names import COMPRESSED_SUFFIX, METADATA_FILE, ROS1_SUFFIX
from linkwright.diagnostics import Phrase, foreign, phrase

_MCAP, _SQLITE, _ZSTD = b"\x89MCAP0\r\n", b"SQLite format 3\0", b"\x28\xb5\x2f\xfd"
_HEAD_BYTES = 64


class ReadFailure(NamedTuple):
    """The reason why a file cannot be read as a recording, with an optional hint and note."""

    reason: Phrase
    hint: Phrase | None
    note: Phrase | None = None


def diagnose(path: Path, error: Exception) -> ReadFailure:
    """Return the reason why a recording cannot be read, with a hint and a note.

    Args:
        path: the path of the recording's file or folder.
        error: the library's error, used as the reason if the file itself does not show one.
    """
    if path.suffix == ROS1_SUFFIX:
        return _make_ros1_failure()
    if missing := _find_missing_files(path):
        names = ", ".join(missing)
        hint = phrase("copy the missing files, or open an existing file by its name")
        return ReadFailure(phrase("files that its metadata.yaml lists are missing: {names}", names=names), hint)
    try:
        with path.open("rb") as file:
            first_bytes = file.read(_HEAD_BYTES)
    except OSError:
        first_bytes = None
    reason = foreign(str(error).strip().rstrip(".") or type(error).__name__)
    if first_bytes is not None and (failure := _diagnose_first_bytes(path, first_bytes)) is not None:
        is_mcap = first_bytes.startswith(_MCAP)  # the error of the library explains what is wrong with an MCAP file
        return failure._replace(note=phrase("the library reports: {reason}", reason=reason)) if is_mcap else failure
    return ReadFailure(reason, None)


def _diagnose_first_bytes(path: Path, first_bytes: bytes) -> ReadFailure | None:
    if not first_bytes:
        return ReadFailure(phrase("the file is empty"), phrase("copy or record it again"))
    if first_bytes.startswith(b"#ROSBAG V"):
        return _make_ros1_failure()
    if first_bytes.startswith(_SQLITE):
        if _has_tables(path):
            return None
        hint = phrase("use the .db3 file that 'ros2 bag record' wrote, with its metadata.yaml")
        return ReadFailure(phrase("it is an SQLite database without the tables of a recording"), hint)
    if first_bytes.startswith(_MCAP):
        hint = phrase("copy it again; 'mcap recover FILE -o OUT.mcap' recovers its complete records")
        return ReadFailure(phrase("it is a damaged or truncated MCAP file"), hint)
    if first_bytes.lstrip().lower().startswith((b"<!doctype html", b"<html")):
        hint = phrase("the download failed: open the file in a browser to see the server's answer")
        return ReadFailure(phrase("it is a web page"), hint)
    if first_bytes.startswith(b"version https://git-lfs"):
        return ReadFailure(
            phrase("it is a Git LFS pointer, not the file itself"), phrase("fetch the file with 'git lfs pull'")
        )
    if path.suffix == COMPRESSED_SUFFIX and first_bytes.startswith(_ZSTD):
        hint = phrase("copy it again; 'unzstd -t' checks whether it is complete")
        return ReadFailure(phrase("its content is damaged or truncated"), hint)
    for magic, format_name in ((_ZSTD, "zstd"), (b"\x1f\x8b", "gzip"), (b"PK\x03\x04", "zip")):
        if first_bytes.startswith(magic):
            return ReadFailure(
                phrase("it is compressed with {kind}", kind=foreign(format_name)), phrase("unpack it first")
            )
    format_by_suffix = {".mcap": "MCAP", ".db3": "SQLite", COMPRESSED_SUFFIX: "zstd"}
    if path.suffix not in format_by_suffix:
        return None
    hint = phrase(
        "the file has the extension {extension} but not its format; copy or record it again", extension=path.suffix
    )
    reason = phrase("it does not begin with a {kind} header", kind=foreign(format_by_suffix[path.suffix]))
    return ReadFailure(reason, hint)


def _find_missing_files(folder: Path) -> list[str]:
    """Return the names of missing files that the metadata of a recording lists."""
    try:
        metadata = yaml.safe_load((folder / METADATA_FILE).read_text(encoding="utf-8"))
        paths = metadata["rosbag2_bagfile_information"]["relative_file_paths"]
        names = [PurePath(path).name for path in paths]
    except (OSError, ValueError, yaml.YAMLError, KeyError, TypeError):
        return []
    return [name for name in names if not (folder / name).exists()]


def _has_tables(path: Path) -> bool:
    """Return whether a database has the tables of a recording.

    The result is also True if the database is too damaged to be read.
    """
    import sqlite3

    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as database:
            names = {name for (name,) in database.execute("SELECT name FROM sqlite_master")}
    except sqlite3.Error:
        return True
    return {"topics", "messages"} <= names


def _make_ros1_failure() -> ReadFailure:
    hint = phrase("convert it to ROS 2 with 'rosbags-convert --src X.bag --dst X'")
    return ReadFailure(phrase("it is a ROS 1 recording"), hint)
