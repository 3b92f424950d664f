"""Determines from the first bytes of a file why it cannot be read as a recording."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path, PurePath
from typing import NamedTuple

import yaml

from linkwright.bag.names import METADATA, PACKED, ROS1
from linkwright.diagnostics import Phrase, foreign, phrase

_MCAP, _SQLITE, _ZSTD = b"\x89MCAP0\r\n", b"SQLite format 3\0", b"\x28\xb5\x2f\xfd"
_HEAD = 64


class Verdict(NamedTuple):
    """The reason why a file is not a readable recording, a hint, and notes."""

    reason: Phrase
    hint: Phrase | None
    note: Phrase | None = None


def diagnose(path: Path, error: Exception) -> Verdict:
    """Determine why a recording cannot be read.

    Args:
        path: the path of the recording's file or folder.
        error: the library's error, which is the reason if the file itself shows none.
    """
    if path.suffix == ROS1:
        return _ros1()
    if missing := _missing_files(path):
        names = ", ".join(missing)
        hint = phrase("copy the missing files, or open an existing file by its name")
        return Verdict(phrase("files that its metadata.yaml names are missing: {names}", names=names), hint)
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD)
    except OSError:
        head = None
    reason = foreign(str(error).strip().rstrip(".") or type(error).__name__)
    if head is not None and (found := _by_its_beginning(path, head)) is not None:
        is_mcap = head.startswith(_MCAP)  # the error of the library explains what is wrong with an MCAP file
        return found._replace(note=phrase("the reader reports: {words}", words=reason)) if is_mcap else found
    return Verdict(reason, None)


def _by_its_beginning(path: Path, head: bytes) -> Verdict | None:
    if not head:
        return Verdict(phrase("the file is empty"), phrase("copy or record it again"))
    if head.startswith(b"#ROSBAG V"):
        return _ros1()
    if head.startswith(_SQLITE):
        if _has_tables(path):
            return None
        hint = phrase("use the .db3 file that 'ros2 bag record' wrote, with its metadata.yaml")
        return Verdict(phrase("it is a database without the tables of a recording"), hint)
    if head.startswith(_MCAP):
        hint = phrase("copy it again; 'mcap recover FILE -o OUT.mcap' recovers its complete records")
        return Verdict(phrase("it is a damaged or truncated MCAP file"), hint)
    if head.lstrip().lower().startswith((b"<!doctype html", b"<html")):
        hint = phrase("the download failed: open the file in a browser to see the server's answer")
        return Verdict(phrase("it is a web page"), hint)
    if head.startswith(b"version https://git-lfs"):
        return Verdict(
            phrase("it is a Git LFS pointer, not the file itself"), phrase("fetch the file with 'git lfs pull'")
        )
    if path.suffix == PACKED and head.startswith(_ZSTD):
        hint = phrase("copy it again; 'unzstd -t' checks whether it is complete")
        return Verdict(phrase("its content is damaged or truncated"), hint)
    for begin, kind in ((_ZSTD, "zstd"), (b"\x1f\x8b", "gzip"), (b"PK\x03\x04", "zip")):
        if head.startswith(begin):
            return Verdict(phrase("it is compressed with {kind}", kind=foreign(kind)), phrase("unpack it first"))
    by_name = {".mcap": "MCAP", ".db3": "SQLite", PACKED: "zstd"}
    if path.suffix not in by_name:
        return None
    hint = phrase("the file has the extension {ending} but not its format; copy or record it again", ending=path.suffix)
    reason = phrase("it does not begin with the {kind} header", kind=foreign(by_name[path.suffix]))
    return Verdict(reason, hint)


def _missing_files(folder: Path) -> list[str]:
    """Return the names of files that a recording's metadata lists but that do not exist."""
    try:
        metadata = yaml.safe_load((folder / METADATA).read_text(encoding="utf-8"))
        paths = metadata["rosbag2_bagfile_information"]["relative_file_paths"]
        names = [PurePath(path).name for path in paths]
    except (OSError, ValueError, yaml.YAMLError, KeyError, TypeError):
        return []
    return [name for name in names if not (folder / name).exists()]


def _has_tables(path: Path) -> bool:
    """Return whether a database has the tables of recordings, or is too damaged to determine that."""
    import sqlite3

    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as database:
            names = {name for (name,) in database.execute("SELECT name FROM sqlite_master")}
    except sqlite3.Error:
        return True
    return {"topics", "messages"} <= names


def _ros1() -> Verdict:
    hint = phrase("convert it to ROS 2 with 'rosbags-convert --src X.bag --dst X'")
    return Verdict(phrase("it is a ROS 1 recording"), hint)
