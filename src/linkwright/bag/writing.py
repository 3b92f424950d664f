"""Write recordings."""

from __future__ import annotations

import contextlib
import sqlite3
import threading
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.bag.names import SUFFIXES, make_numbered_path
from linkwright.bag.qos import to_library
from linkwright.bag.snapshots import LatestMessages
from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, missing_extra, phrase
from linkwright.files import unfinished
from linkwright.messages import type_hash
from linkwright.messages.schema_text import schema_of
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from typing_extensions import Self

    from linkwright.bag.parts import RecordingFile
    from linkwright.graph import QoSProfile

STORAGES = ("mcap", "sqlite3")
"""The storage formats. As in ROS 2 since Iron, the first one is the default."""

COMPRESSIONS = ("none", "file", "message", "storage")
"""The unit of compression with zstd: none, whole files, single messages, or the chunks of an MCAP file."""

_MIN_SPLIT_SIZES = {"mcap": 1024, "sqlite3": 86016}
"""The minimum file sizes that rosbag2's storages accept for splitting, in bytes."""

_WRITE_ERRORS = (OSError, sqlite3.Error)
"""The errors that a full disk causes."""


_MAX_WRITE_S = 30.0
"""The seconds that `BagWriter.finish` waits for another thread's write. Disks can be slow."""


class BagWriter:
    """A recording that is being written.

    Close it, or use it in a ``with`` statement. The recording is completed even if a signal other than SIGKILL ends the
    process (`unfinished`). Files are named and split as by rosbag2's ``SequentialWriter``.

    Args:
        path: the folder to create, or the file if `single_file` is set.
        storage: one of `STORAGES`.
        compression: one of `COMPRESSIONS`.
        single_file: whether to write only an MCAP file, which needs no separate metadata; rosbag2 creates a folder.
        max_size: the size in bytes after which a new file is begun; 0 for no limit.
        max_seconds: the duration in seconds after which a new file is begun; 0 for no limit.
        snapshot_size: the size in bytes of a buffer for the latest messages, which only `take_snapshot` writes; 0 to
            write all messages at once.
        custom_data: additional entries of the metadata.

    Raises:
        LinkwrightError: BAG105, the folder already exists or cannot be created; BAG107, `rosbags` is not installed;
            BAG116, the requested file size is too small.

    Attributes:
        path: the argument `path`.
        on_split: called with the names of the closed file and of the new file, when a new file is begun.
    """

    def __init__(
        self,
        path: str | Path,
        storage: str = STORAGES[0],
        *,
        compression: str = "none",
        single_file: bool = False,
        max_size: int = 0,
        max_seconds: float = 0.0,
        snapshot_size: int = 0,
        custom_data: Mapping[str, str] | None = None,
    ) -> None:
        try:
            import rosbags.rosbag2  # noqa: F401  # whether it is installed
        except ModuleNotFoundError as error:
            raise missing_extra("BAG107", error) from None

        self.path = Path(path)
        self.on_split: Callable[[str, str], object] = lambda _closed, _begun: None
        self._is_single_file = single_file
        self._suffix = next(suffix for suffix, name in SUFFIXES.items() if name == storage)
        self._compression = compression
        self._max_size, self._max_ns = max_size, round(max_seconds * NANOSECONDS_PER_SECOND)
        self._custom_data = dict(custom_data or {})
        self._snapshot_buffer = LatestMessages(snapshot_size) if snapshot_size else None
        self._topics: dict[str, tuple[str, str, str, list[Any]]] = {}
        self._file_metadata: list[dict[str, Any]] = []
        self._lock = threading.RLock()
        self._is_ending = False
        if 0 < max_size < _MIN_SPLIT_SIZES[storage]:
            raise _split_size_error(max_size, _MIN_SPLIT_SIZES[storage])
        self._part: RecordingFile | None = self._open_first_file()
        unfinished.register_unfinished(self)

    @property
    def topics(self) -> Collection[str]:
        """The topics that have been added so far."""
        return self._topics.keys()

    @property
    def size(self) -> int:
        """The number of bytes written to files so far."""
        if self._is_single_file:
            return self.path.stat().st_size
        return sum(path.stat().st_size for path in self.path.iterdir())

    def add_topic(self, name: str, type_name: str, offered_qos: Collection[QoSProfile] = ()) -> None:
        """Add a topic, so that its messages can be written.

        Raises:
            LinkwrightError: MSG101, the type is not available; BAG108, a file cannot be written.
        """
        topic_entry = (type_name, schema_of(type_name), type_hash(type_name), [to_library(qos) for qos in offered_qos])
        with self._lock:
            if self._part is None:
                return
            try:
                self._part.add_topic(name, *topic_entry)
            except _WRITE_ERRORS as error:
                raise self._stop_with(error) from error
            self._topics[name] = topic_entry

    def set_custom_data(self, name: str, value: str) -> None:
        """Set an additional entry of the metadata of this and all later files."""
        with self._lock:
            self._custom_data[name] = value
            if self._part is not None:
                self._part.set_custom_data(name, value)

    def write(self, topic: str, stamp_ns: int, data: bytes | memoryview) -> None:
        """Write a message, or buffer it if `snapshot_size` is set.

        Args:
            topic: a topic that was added.
            stamp_ns: the reception time, in nanoseconds since the epoch.
            data: the serialized message with the encapsulation header of four bytes.

        Raises:
            LinkwrightError: BAG108, the file cannot be written; the messages written before can still be played.
        """
        if self._is_ending:  # a continuous writer could starve the thread that closes the recording
            return
        with self._lock:
            if self._part is None:
                return
            if self._snapshot_buffer is not None:
                self._snapshot_buffer.add(topic, stamp_ns, data)
                return
            try:
                self._write(topic, stamp_ns, data)
            except _WRITE_ERRORS as error:
                raise self._stop_with(error) from error

    def take_snapshot(self) -> bool:
        """Write the buffered messages to the recording.

        Returns:
            False if the recording is not in snapshot mode, else True.

        Raises:
            LinkwrightError: BAG108, the file cannot be written.
        """
        with self._lock:
            if self._snapshot_buffer is None:
                return False
            for message in self._snapshot_buffer.take_all():
                if self._part is None:
                    break
                try:
                    self._write(*message)
                except _WRITE_ERRORS as error:
                    raise self._stop_with(error) from error
            self.flush()
            return True

    def split(self) -> None:
        """Begin a new file.

        Do nothing for a single file or a closed recording.

        Raises:
            LinkwrightError: BAG108, a file cannot be written.
        """
        with self._lock:
            try:
                self._split()
            except _WRITE_ERRORS as error:
                raise self._stop_with(error) from error

    def flush(self) -> None:
        """Pass buffered messages to the operating system.

        There the messages survive a crash of this process.

        Raises:
            LinkwrightError: BAG108, the file cannot be written.
        """
        with self._lock:
            if self._part is None:
                return
            try:
                self._part.flush()
            except _WRITE_ERRORS as error:
                raise self._stop_with(error) from error

    def close(self) -> None:
        """Write the index and the metadata, and close the files.

        A second call, or a call after a write error, has no effect.

        Raises:
            LinkwrightError: BAG108, a file cannot be written.
        """
        from linkwright.bag.parts import write_metadata

        with self._lock:
            if self._part is None:
                return
            try:
                self._file_metadata.append(self._part.close())
                if not self._is_single_file:
                    write_metadata(self.path, self._file_metadata)
            except _WRITE_ERRORS as error:
                raise self._stop_with(error) from error
            self._part = None
            unfinished.unregister_finished(self)

    def finish(self) -> None:
        """Close the recording because the process ends.

        Callable from any thread except the writing one.
        """
        self._is_ending = True
        if not self._lock.acquire(timeout=_MAX_WRITE_S):
            return
        try:
            with contextlib.suppress(LinkwrightError):  # the process is ending, so an error can no longer be reported
                self.close()
        finally:
            self._lock.release()

    def _open_first_file(self) -> RecordingFile:
        folder = self.path.parent if self._is_single_file else self.path
        try:
            if self.path.exists():
                raise FileExistsError
            folder.mkdir(mode=0o755, parents=True, exist_ok=self._is_single_file)
            return self._open_file(
                self.path if self._is_single_file else make_numbered_path(self.path, 0, self._suffix)
            )
        except OSError as error:
            reason = "it exists already" if self.path.exists() else str(error)
            raise LinkwrightError(
                Diagnostic(
                    "BAG105",
                    phrase(
                        "recording '{path}' cannot be created: {reason}",
                        path=display_path(self.path),
                        reason=foreign(reason),
                    ),
                    hint=phrase("choose another file") if self._is_single_file else phrase("choose another folder"),
                )
            ) from error

    def _open_file(self, path: Path) -> RecordingFile:
        from linkwright.bag.parts import RecordingFile

        file = RecordingFile(path, self._compression, self._custom_data)
        for name, topic_entry in self._topics.items():
            file.add_topic(name, *topic_entry)
        return file

    def _write(self, topic: str, stamp_ns: int, data: bytes | memoryview) -> None:
        file = self._part
        assert file is not None
        is_old = self._max_ns and file.start_ns is not None and stamp_ns - file.start_ns > self._max_ns
        if is_old or (self._max_size and file.size >= self._max_size):
            self._split()
        self._part.write(topic, stamp_ns, data)  # type: ignore[union-attr]  # there is one still

    def _split(self) -> None:
        if self._part is None or self._is_single_file:
            return
        old_file = self._part
        self._file_metadata.append(old_file.close())
        self._part = self._open_file(make_numbered_path(self.path, len(self._file_metadata), self._suffix))
        self.on_split(str(old_file.path), str(self._part.path))

    def _stop_with(self, error: Exception) -> LinkwrightError:
        """Stop writing after an error, and return the LinkwrightError for it."""
        unfinished.unregister_finished(self)
        file, self._part = self._part, None
        with contextlib.suppress(*_WRITE_ERRORS):  # closing tries to write the buffer again, which fails again
            if file is not None:
                file.abort()
        reason = error.strerror if isinstance(error, OSError) else str(error)
        message = phrase(
            "recording to '{path}' stopped: {reason}", path=display_path(self.path), reason=foreign(reason or error)
        )
        hint = phrase("the messages written so far are kept; `linkwright bag play` plays them")
        return LinkwrightError(Diagnostic("BAG108", message, hint=hint))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _split_size_error(size: int, min_size: int) -> LinkwrightError:
    message = phrase("a recording cannot be split into files as small as {size} bytes", size=size)
    return LinkwrightError(
        Diagnostic("BAG116", message, hint=phrase("use a size of {minimum} bytes or more", minimum=min_size))
    )
