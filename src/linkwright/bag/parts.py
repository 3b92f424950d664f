"""Write the files of a recording, and the ``metadata.yaml`` that lists them."""

from __future__ import annotations

import sqlite3
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import yaml
from rosbags.interfaces import Qos
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from linkwright.bag.names import METADATA_FILE, SUFFIXES
from linkwright.files import whole_files
from linkwright.files.scratch_folders import ScratchFolder

VERSION: Literal[8] = 8
"""The version of the metadata. Humble reads versions up to 8, except for unknown fields. Jazzy writes 9."""

INFORMATION_KEY = "rosbag2_bagfile_information"
"""The top-level key of ``metadata.yaml``."""

_Metadata = dict[str, Any]


class RecordingFile:
    """A file of a recording that is being written.

    Args:
        path: the file to create, with its suffix.
        compression: one of `linkwright.bag.writing.COMPRESSIONS`.
        custom_data: additional entries of the metadata.

    Attributes:
        start_ns: the reception time of the first message, in nanoseconds since the epoch; None if there is no message.
        path: the path of the file; it gets a second suffix when a compressed file is closed.
    """

    def __init__(self, path: Path, compression: str, custom_data: Mapping[str, str]) -> None:
        plugin = StoragePlugin[SUFFIXES[path.suffix].upper()]
        self._writer = Writer(path, version=VERSION, storage_plugin=plugin)
        self._writer.set_compression(CompressionMode[compression.upper()], CompressionFormat.ZSTD)
        self._writer.custom_data = dict(custom_data)
        target: Any = _FixedPath(path)
        self._writer.storage = Writer.STORAGE_PLUGINS[plugin](target, self._writer.compression_mode)
        if hasattr(self._writer.storage, "conn"):
            _allow_all_threads(self._writer.storage)
        self._connections: dict[str, Any] = {}
        self.start_ns: int | None = None
        self.path = path

    @property
    def storage(self) -> Any:
        """The library's storage of the file, or None after the file was closed."""
        return self._writer.storage

    @property
    def size(self) -> int:
        """The number of bytes written so far, including buffered bytes."""
        storage = self.storage
        if hasattr(storage, "conn"):
            (page_count,) = storage.conn.execute("PRAGMA page_count").fetchone()
            (page_size,) = storage.conn.execute("PRAGMA page_size").fetchone()
            return int(page_count) * int(page_size)
        return int(storage.bio.tell() + storage.chunk.bio.tell())

    def add_topic(self, name: str, type_name: str, schema: str, digest: str, offered_qos: Collection[Qos]) -> None:
        """Add a topic."""
        self._connections[name] = self._writer.add_connection(
            name, type_name, msgdef=schema, rihs01=digest, offered_qos_profiles=list(offered_qos)
        )

    def set_custom_data(self, name: str, value: str) -> None:
        """Set an additional entry of the metadata."""
        self._writer.custom_data[name] = value

    def write(self, topic: str, stamp_ns: int, data: bytes | memoryview) -> None:
        """Append a message."""
        self._writer.write(self._connections[topic], stamp_ns, data)
        self.start_ns = stamp_ns if self.start_ns is None else min(self.start_ns, stamp_ns)

    def flush(self) -> None:
        """Write all buffered messages to the operating system."""
        storage = self.storage
        if hasattr(storage, "close_chunk"):
            if storage.chunk.msgs:
                storage.close_chunk()
            storage.bio.flush()
        else:
            storage.conn.commit()

    def close(self) -> _Metadata:
        """Write the index, close the file, and return the metadata of this file."""
        with ScratchFolder("bag") as folder:  # the library writes the metadata into this folder
            self._writer.metapath = Path(folder) / METADATA_FILE
            self._writer.close()
            document = yaml.safe_load(self._writer.metapath.read_text(encoding="utf-8"))
        information: _Metadata = document[INFORMATION_KEY]
        self.path = self.path.with_name(information["relative_file_paths"][0])
        return information

    def abort(self) -> None:
        """Close the file without an index and metadata."""
        self._writer.abort()


def write_metadata(folder: Path, file_metadata: Sequence[_Metadata]) -> None:
    """Write the ``metadata.yaml`` of a recording.

    Args:
        folder: the folder of the recording.
        file_metadata: the metadata of the recording's files, one or more.
    """
    write_information(folder, _combine(file_metadata))


def write_information(folder: Path, information: _Metadata) -> None:
    """Write metadata to the ``metadata.yaml`` in a folder."""
    text = yaml.safe_dump({INFORMATION_KEY: information}, sort_keys=False, allow_unicode=True)
    whole_files.write_whole_file(folder / METADATA_FILE, text)


def _combine(file_metadata: Sequence[_Metadata]) -> _Metadata:
    """Combine the metadata of several files into the metadata of one recording."""
    files = [item for metadata in file_metadata for item in metadata["files"]]
    times_and_durations = [
        (file["starting_time"]["nanoseconds_since_epoch"], file["duration"]["nanoseconds"])
        for file in files
        if file["message_count"]
    ]
    topics: dict[tuple[str, str], _Metadata] = {}
    for topic in (topic for part in file_metadata for topic in part["topics_with_message_count"]):
        key = topic["topic_metadata"]["name"], topic["topic_metadata"]["type"]
        merged = topics.get(key)
        topics[key] = {**topic, "message_count": topic["message_count"] + (merged["message_count"] if merged else 0)}
    start = min(
        (start for start, _ in times_and_durations),
        default=file_metadata[0]["starting_time"]["nanoseconds_since_epoch"],
    )
    return {
        **file_metadata[-1],
        "relative_file_paths": [file["path"] for file in files],
        "files": files,
        "starting_time": {"nanoseconds_since_epoch": start},
        "duration": {
            "nanoseconds": max((file_start + length for file_start, length in times_and_durations), default=start)
            - start
        },
        "message_count": sum(file["message_count"] for file in files),
        "topics_with_message_count": list(topics.values()),
    }


def _allow_all_threads(storage: Any) -> None:
    """Replace the library's database connection with one that any thread can use."""
    storage.conn.close()
    storage.conn = sqlite3.connect(f"file:{storage.path}", uri=True, check_same_thread=False)
    storage.cursor = storage.conn.cursor()


class _FixedPath:
    """A substitute for the library's folder that makes the library write to a given path."""

    def __init__(self, path: Path) -> None:
        self.name = path.stem
        self._path = path

    def __truediv__(self, name: str) -> Path:
        return self._path
