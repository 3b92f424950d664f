"""Writing a recording."""

from __future__ import annotations

import contextlib
import sqlite3
import threading
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from linkwright import unfinished
from linkwright.bag.qos import to_bag
from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, missing_extra, phrase
from linkwright.messages import type_hash
from linkwright.messages.schema_text import schema_of
from linkwright.scratch_folders import ScratchFolder

if TYPE_CHECKING:
    from typing_extensions import Self

    from linkwright.graph import QoSProfile

STORAGES = ("mcap", "sqlite3")
"""The file formats; the first is the default, as in ROS 2 from Iron on."""

_REFUSALS = (OSError, sqlite3.Error)
"""The errors of a full disk."""

_VERSION: Literal[8] = 8
"""The version of the metadata; Humble reads 8 and below but for unknown fields, Jazzy writes 9."""

_LONGEST_WRITE = 30.0
"""Seconds that `BagWriter.finish` waits for another thread to write what it is writing: disks may be slow."""


class BagWriter:
    """A recording that is being written; close it, or use it in a ``with`` statement.

    It gets its end however a signal ends the process, but for SIGKILL (`unfinished`).

    Args:
        path: the folder to make; of a single file, the file.
        storage: one of `STORAGES`.
        compressed: whether chunks of messages are compressed (zstd); MCAP only.
        single_file: whether there is an MCAP file alone, which needs no metadata beside it; rosbag2 makes a folder.

    Raises:
        LinkwrightError: BAG105, the folder exists already or cannot be made; BAG107, `rosbags` is not installed.
    """

    def __init__(
        self, path: str | Path, storage: str = STORAGES[0], *, compressed: bool = False, single_file: bool = False
    ) -> None:
        try:
            from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
            from rosbags.rosbag2.errors import WriterError
        except ModuleNotFoundError as error:
            raise missing_extra("BAG107", error) from None

        self.path = Path(path)
        self._is_file = single_file
        plugin = StoragePlugin.MCAP if single_file else StoragePlugin[storage.upper()]
        try:
            self._writer = Writer(self.path, version=_VERSION, storage_plugin=plugin)
            if compressed:
                self._writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
            if single_file:
                self.path.parent.mkdir(parents=True, exist_ok=True)
                into: Any = _File(self.path)
                self._writer.storage = Writer.STORAGE_PLUGINS[plugin](into, self._writer.compression_mode)
            else:
                self._writer.open()
        except (OSError, WriterError) as error:
            reason = "it exists already" if self.path.exists() else str(error)
            raise LinkwrightError(
                Diagnostic(
                    "BAG105",
                    phrase(
                        "recording '{path}' cannot be made: {reason}",
                        path=display_path(self.path),
                        reason=foreign(reason),
                    ),
                    hint=phrase("name another file") if single_file else phrase("name another folder"),
                )
            ) from error
        self._connections: dict[str, Any] = {}
        self._lock = threading.RLock()
        self._is_ending = False
        if hasattr(self._writer.storage, "conn"):
            _let_any_thread_close(self._writer.storage)
        unfinished.begun(self)

    @property
    def topics(self) -> Collection[str]:
        """The topics added so far."""
        return self._connections.keys()

    @property
    def size(self) -> int:
        """Bytes of its files, as far as they are written."""
        if self._is_file:
            return self.path.stat().st_size
        return sum(each.stat().st_size for each in self.path.iterdir())

    def add_topic(self, name: str, type_name: str, offered_qos: Collection[QoSProfile] = ()) -> None:
        """Add a topic, whose messages may follow.

        Raises:
            LinkwrightError: MSG101, the type is not known; BAG108, the disk refuses.
        """
        schema, digest, offered = schema_of(type_name), type_hash(type_name), [to_bag(qos) for qos in offered_qos]
        with self._lock:
            if self._writer.storage is None:
                return
            try:
                self._connections[name] = self._writer.add_connection(
                    name, type_name, msgdef=schema, rihs01=digest, offered_qos_profiles=offered
                )
            except _REFUSALS as error:
                raise self._ended(error) from error

    def write(self, topic: str, stamp_ns: int, data: bytes | memoryview) -> None:
        """Add a message.

        Args:
            topic: a topic that was added.
            stamp_ns: when it was received, nanoseconds since the epoch.
            data: CDR bytes with their header of four.

        Raises:
            LinkwrightError: BAG108, the disk refuses; what was written until then can be played.
        """
        if self._is_ending:  # who finishes it waits for the lock, and who writes all the time might always get it
            return
        with self._lock:
            if self._writer.storage is None:
                return
            try:
                self._writer.write(self._connections[topic], stamp_ns, data)
            except _REFUSALS as error:
                raise self._ended(error) from error

    def flush(self) -> None:
        """Flush, so that what was written survives the end of this process, however it ends.

        Raises:
            LinkwrightError: BAG108, the disk refuses.
        """
        with self._lock:
            storage: Any = self._writer.storage
            if storage is None:
                return
            try:
                if hasattr(storage, "close_chunk"):
                    if storage.chunk.msgs:
                        storage.close_chunk()
                    storage.bio.flush()
                else:
                    storage.conn.commit()
            except _REFUSALS as error:
                raise self._ended(error) from error

    def close(self) -> None:
        """Write the index and the metadata. A second call, and one after the disk refused something, does nothing.

        Raises:
            LinkwrightError: BAG108, the disk refuses.
        """
        with self._lock:
            if self._writer.storage is None:
                return
            try:
                if self._is_file:
                    self._close_file()
                else:
                    self._writer.close()
            except _REFUSALS as error:
                raise self._ended(error) from error
            unfinished.finished(self)

    def finish(self) -> None:
        """`close` from another thread than the one that writes, before the process is ended."""
        self._is_ending = True
        if not self._lock.acquire(timeout=_LONGEST_WRITE):
            return
        try:
            with contextlib.suppress(LinkwrightError):  # nobody can be told any more
                self.close()
        finally:
            self._lock.release()

    def _close_file(self) -> None:
        """Close a single file, which has the metadata in it; the library writes them into a folder, too."""
        with ScratchFolder("bag") as folder:
            self._writer.metapath = Path(folder) / self._writer.metapath.name
            self._writer.close()

    def _ended(self, error: Exception) -> LinkwrightError:
        """The error when the disk refuses something; nothing more is written then."""
        unfinished.finished(self)
        storage, self._writer.storage = self._writer.storage, None
        with contextlib.suppress(*_REFUSALS):  # what waits in its buffer is refused again
            if storage is not None:
                storage.abort()
        reason = error.strerror if isinstance(error, OSError) else str(error)
        message = phrase(
            "recording '{path}' ends here: {reason}", path=display_path(self.path), reason=foreign(reason or error)
        )
        hint = phrase("what was written until then is kept, and `linkwright bag play` plays it")
        return LinkwrightError(Diagnostic("BAG108", message, hint=hint))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _let_any_thread_close(storage: Any) -> None:
    """Connect to a database again: the library's connection may be used in one thread only."""
    storage.conn.close()
    storage.conn = sqlite3.connect(f"file:{storage.path}", uri=True, check_same_thread=False)
    storage.cursor = storage.conn.cursor()


class _File:
    """A file in the place of the folder that the library makes its file in."""

    def __init__(self, path: Path) -> None:
        self.name = path.stem
        self._path = path

    def __truediv__(self, name: str) -> Path:
        return self._path
