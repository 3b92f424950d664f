"""Writes recordings."""

from __future__ import annotations

import contextlib
import sqlite3
import threading
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.bag.names import SUFFIXES, numbered
from linkwright.bag.qos import to_bag
from linkwright.bag.snapshots import LatestMessages
from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, missing_extra, phrase
from linkwright.files import unfinished
from linkwright.messages import type_hash
from linkwright.messages.schema_text import schema_of
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from typing_extensions import Self

    from linkwright.bag.parts import Part
    from linkwright.graph import QoSProfile

STORAGES = ("mcap", "sqlite3")
"""The file formats; the first is the default, as in ROS 2 from Iron on."""

COMPRESSIONS = ("none", "file", "message", "storage")
"""The parts that are compressed with zstd: none, whole files, single messages, or the chunks of an MCAP file."""

_SMALLEST_SPLITS = {"mcap": 1024, "sqlite3": 86016}
"""The least file sizes that rosbag2's storages accept, in bytes."""

_REFUSALS = (OSError, sqlite3.Error)
"""The errors of a full disk."""


_LONGEST_WRITE = 30.0
"""Seconds that `BagWriter.finish` waits for another thread to finish its write: disks may be slow."""


class BagWriter:
    """A recording that is being written; close it, or use it in a ``with`` statement.

    The recording is completed even if a signal other than SIGKILL ends the process (`unfinished`). Files are named and
    split as by rosbag2's ``SequentialWriter``.

    Args:
        path: the folder to create, or the file if `single_file` is set.
        storage: one of `STORAGES`.
        compression: one of `COMPRESSIONS`.
        single_file: whether to write only an MCAP file, which needs no separate metadata; rosbag2 creates a folder.
        max_size: the size in bytes after which another file is begun; 0 for no limit.
        max_seconds: the duration in seconds after which another file is begun; 0 for no limit.
        snapshot_size: if positive, only `take_snapshot` writes messages, and this is the size in bytes of the buffer
            for the latest messages.
        custom_data: additional entries of the metadata.

    Raises:
        LinkwrightError: BAG105, the folder exists already or cannot be created; BAG107, `rosbags` is not installed;
            BAG116, the requested file size is too small.

    Attributes:
        path: the argument `path`.
        on_split: called with the names of the closed file and of the new file.
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
        self._is_file = single_file
        self._suffix = next(suffix for suffix, name in SUFFIXES.items() if name == storage)
        self._compression = compression
        self._max_size, self._max_ns = max_size, round(max_seconds * NANOSECONDS_PER_SECOND)
        self._custom_data = dict(custom_data or {})
        self._latest = LatestMessages(snapshot_size) if snapshot_size else None
        self._topics: dict[str, tuple[str, str, str, list[Any]]] = {}
        self._done: list[dict[str, Any]] = []
        self._lock = threading.RLock()
        self._is_ending = False
        if 0 < max_size < _SMALLEST_SPLITS[storage]:
            raise _too_small(max_size, _SMALLEST_SPLITS[storage])
        self._part: Part | None = self._first_part()
        unfinished.register_unfinished(self)

    @property
    def topics(self) -> Collection[str]:
        """The topics that have been added so far."""
        return self._topics.keys()

    @property
    def size(self) -> int:
        """The number of bytes written to files so far."""
        if self._is_file:
            return self.path.stat().st_size
        return sum(path.stat().st_size for path in self.path.iterdir())

    def add_topic(self, name: str, type_name: str, offered_qos: Collection[QoSProfile] = ()) -> None:
        """Add a topic, so that messages of the topic can be written.

        Raises:
            LinkwrightError: MSG101, the type is not known; BAG108, a file cannot be written.
        """
        facts = (type_name, schema_of(type_name), type_hash(type_name), [to_bag(qos) for qos in offered_qos])
        with self._lock:
            if self._part is None:
                return
            try:
                self._part.add_topic(name, *facts)
            except _REFUSALS as error:
                raise self._ended(error) from error
            self._topics[name] = facts

    def write(self, topic: str, stamp_ns: int, data: bytes | memoryview) -> None:
        """Write a message; with `snapshot_size`, buffer it for a snapshot instead.

        Args:
            topic: a topic that was added.
            stamp_ns: the time of reception, in nanoseconds since the epoch.
            data: CDR bytes including the encapsulation header of four bytes.

        Raises:
            LinkwrightError: BAG108, the file cannot be written; messages that were written before can still be played.
        """
        if self._is_ending:  # let the ending thread acquire the lock, which a continuous writer might always get first
            return
        with self._lock:
            if self._part is None:
                return
            if self._latest is not None:
                self._latest.add(topic, stamp_ns, data)
                return
            try:
                self._write(topic, stamp_ns, data)
            except _REFUSALS as error:
                raise self._ended(error) from error

    def take_snapshot(self) -> bool:
        """Write the buffered messages.

        Returns:
            Whether messages are buffered for snapshots.

        Raises:
            LinkwrightError: BAG108, the file cannot be written.
        """
        with self._lock:
            if self._latest is None:
                return False
            for message in self._latest.taken():
                if self._part is None:
                    break
                try:
                    self._write(*message)
                except _REFUSALS as error:
                    raise self._ended(error) from error
            self.flush()
            return True

    def split(self) -> None:
        """Start a new file; for a single file or a closed recording, do nothing.

        Raises:
            LinkwrightError: BAG108, a file cannot be written.
        """
        with self._lock:
            try:
                self._split()
            except _REFUSALS as error:
                raise self._ended(error) from error

    def flush(self) -> None:
        """Pass the written messages to the operating system, so that they survive a crash of this process.

        Raises:
            LinkwrightError: BAG108, the file cannot be written.
        """
        with self._lock:
            if self._part is None:
                return
            try:
                self._part.flush()
            except _REFUSALS as error:
                raise self._ended(error) from error

    def close(self) -> None:
        """Write the index and the metadata, and close the files.

        A second call has no effect, and neither has a call after a write error.

        Raises:
            LinkwrightError: BAG108, a file cannot be written.
        """
        from linkwright.bag.parts import write_metadata

        with self._lock:
            if self._part is None:
                return
            try:
                self._done.append(self._part.close())
                if not self._is_file:
                    write_metadata(self.path, self._done)
            except _REFUSALS as error:
                raise self._ended(error) from error
            self._part = None
            unfinished.unregister_finished(self)

    def finish(self) -> None:
        """Close the recording before the process ends, from a thread other than the writing thread."""
        self._is_ending = True
        if not self._lock.acquire(timeout=_LONGEST_WRITE):
            return
        try:
            with contextlib.suppress(LinkwrightError):  # the process is ending, so an error can no longer be reported
                self.close()
        finally:
            self._lock.release()

    def _first_part(self) -> Part:
        folder = self.path.parent if self._is_file else self.path
        try:
            if self.path.exists():
                raise FileExistsError
            folder.mkdir(mode=0o755, parents=True, exist_ok=self._is_file)
            return self._new_part(self.path if self._is_file else numbered(self.path, 0, self._suffix))
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
                    hint=phrase("name another file") if self._is_file else phrase("name another folder"),
                )
            ) from error

    def _new_part(self, path: Path) -> Part:
        from linkwright.bag.parts import Part

        part = Part(path, self._compression, self._custom_data)
        for name, facts in self._topics.items():
            part.add_topic(name, *facts)
        return part

    def _write(self, topic: str, stamp_ns: int, data: bytes | memoryview) -> None:
        part = self._part
        assert part is not None
        is_old = self._max_ns and part.start_ns is not None and stamp_ns - part.start_ns > self._max_ns
        if is_old or (self._max_size and part.size >= self._max_size):
            self._split()
        self._part.write(topic, stamp_ns, data)  # type: ignore[union-attr]  # there is one still

    def _split(self) -> None:
        if self._part is None or self._is_file:
            return
        closed = self._part
        self._done.append(closed.close())
        self._part = self._new_part(numbered(self.path, len(self._done), self._suffix))
        self.on_split(str(closed.path), str(self._part.path))

    def _ended(self, error: Exception) -> LinkwrightError:
        """Stop writing, and return the LinkwrightError for a write error."""
        unfinished.unregister_finished(self)
        part, self._part = self._part, None
        with contextlib.suppress(*_REFUSALS):  # closing tries to write the buffer again, which fails again
            if part is not None:
                part.abort()
        reason = error.strerror if isinstance(error, OSError) else str(error)
        message = phrase(
            "recording to '{path}' stops: {reason}", path=display_path(self.path), reason=foreign(reason or error)
        )
        hint = phrase("the messages written so far are kept; `linkwright bag play` plays them")
        return LinkwrightError(Diagnostic("BAG108", message, hint=hint))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _too_small(size: int, smallest: int) -> LinkwrightError:
    message = phrase("files of {size} bytes are too small to split a recording into", size=size)
    return LinkwrightError(Diagnostic("BAG116", message, hint=phrase("give {smallest} or more", smallest=smallest)))
