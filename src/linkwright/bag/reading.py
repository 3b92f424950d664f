"""Reads a recording: its topics, and its messages ordered by time."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.bag.moments import Moments
from linkwright.bag.names import METADATA, PACKED, Recorded, are_of_one_recording, storage_of
from linkwright.bag.qos import from_bag
from linkwright.bag.scratch import scratch_folder
from linkwright.bag.unfinished import is_unfinished, make_readable
from linkwright.bag.unreadable import diagnose
from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Note,
    Severity,
    did_you_mean,
    display_path,
    missing_extra,
    phrase,
)
from linkwright.messages import add_definitions

if TYPE_CHECKING:
    from rosbags.rosbag2 import Reader
    from typing_extensions import Self

    from linkwright.graph import QoSProfile

T = TypeVar("T")

_OURS = "cdr"
"""The serialization of ROS 2's messages; topics with another one are left out."""


@dataclass(frozen=True, slots=True)
class BagTopic:
    """A topic of a recording.

    Attributes:
        name: the absolute name.
        type_name: the type, such as ``std_msgs/msg/String``.
        count: the number of messages.
        serialization_format: ``cdr``.
        offered_qos: the recorded profiles of the publishers; empty if they were not recorded.
    """

    name: str
    type_name: str
    count: int
    serialization_format: str
    offered_qos: tuple[QoSProfile, ...]


class BagReader:
    """An open recording; close it, or use it in a ``with`` statement.

    Unknown message types are registered from the definitions in the recording.

    Args:
        path: a folder with a ``metadata.yaml``, or a single ``.mcap`` or ``.db3`` file. If the recorder was killed,
            there is neither a ``metadata.yaml`` nor an index, and everything that was written is read. A
            folder can also contain only the numbered files of one recording.
        called: the name of the recording in messages; None for its path.
        parts: the files of the recording, with any names, if several files are read as one recording.

    Raises:
        LinkwrightError: BAG101, the path does not exist; BAG102, the path is not a recording, or the recording is
            damaged; BAG107, `rosbags` is not installed.
    """

    def __init__(self, path: str | Path, called: str | None = None, parts: Sequence[Path] = ()) -> None:
        try:
            import rosbags.rosbag2  # noqa: F401  # whether it is installed
        except ModuleNotFoundError as error:
            raise missing_extra("BAG107", error) from None
        self.path = Path(path)
        self._called = display_path(self.path) if called is None else called
        self._open = ExitStack()
        self._is_cut_off = False
        self._targets = list(parts) or _storage_targets(self.path, self._called)
        try:
            self._reader = self._opened(self._targets)
        except BaseException:
            self._open.close()
            raise
        self.storage = _storage_of(self._targets[0])
        self._moments = Moments(self._reader)
        self._make_types_known()
        self._others = {
            connection.topic: form or "?"
            for connection in self._reader.connections
            if (form := _format_of(connection)) != _OURS
        }
        self.topics = [
            BagTopic(
                name,
                info.msgtype or "",
                info.msgcount,
                _format_of(info.connections[0]),
                tuple(from_bag(qos) for connection in info.connections for qos in _profiles(connection)),
            )
            for name, info in self._reader.topics.items()
            if name not in self._others
        ]
        if self._others and not self.topics:
            self.close()
            message = phrase("'{path}' is not a ROS 2 recording: {topics}", path=self._called, topics=self._left_out())
            raise LinkwrightError(
                Diagnostic("BAG102", message, hint=phrase("the brackets show the encoding of each topic's messages"))
            )

    def _opened(self, targets: Sequence[Path]) -> Reader:
        if len(targets) == 1:
            return self._opened_one(targets[0], self.path, self._called)
        from linkwright.bag.several import SeveralReader

        # A file is empty if the recorder is killed right after creating it.
        whole = [target for target in targets if target.stat().st_size] or targets
        self._is_cut_off = len(whole) < len(targets)
        return SeveralReader([self._opened_one(path, path, path.name) for path in whole])

    def _opened_one(self, target: Path, path: Path, called: str) -> Reader:
        from rosbags.rosbag2 import Reader

        try:
            reader = Reader(self._finished(target))
            reader.open()
            self._open.callback(reader.close)
            if hasattr(reader.storage, "storages"):
                _ignore_profiles_of_files(reader.storage)
            if target.is_file():
                from linkwright.bag.packed import unpack_messages

                unpack_messages(reader)
        except Exception as error:  # a damaged file can make the library raise any exception
            raise _unreadable(path, called, error) from error
        return reader

    def _finished(self, target: Path) -> Any:
        """Return what to pass to the library: the path, or an in-memory file with the missing parts added.

        Parts that the library would reject are removed from the in-memory file.
        """
        if target.is_file() and target.suffix == PACKED:
            from linkwright.bag.packed import decompress_file

            target = decompress_file(target, Path(self._open.enter_context(scratch_folder())))
        files = sorted(target.glob("*.mcap")) if target.is_dir() else [target]
        if len(files) != 1 or files[0].suffix != ".mcap":
            return target
        self._is_cut_off = self._is_cut_off or is_unfinished(files[0])
        return make_readable(files[0]) or target

    def _make_types_known(self) -> None:
        from rosbags.interfaces import MessageDefinitionFormat

        origin = self._called
        for connection in self._reader.connections:
            form, text = connection.msgdef
            if form is not MessageDefinitionFormat.NONE:
                add_definitions(connection.msgtype, text, origin, idl=form is MessageDefinitionFormat.IDL)

    @property
    def findings(self) -> list[Diagnostic]:
        """The diagnostics of the recording.

        They report a recording without an end, because the recorder was killed or the copy is truncated (BAG109),
        topics that are not ROS 2's (BAG112), and a recording without messages (BAG113).
        """
        found = []
        if not self._is_cut_off and not any(topic.count for topic in self.topics):
            message = phrase("recording '{path}' holds no messages", path=self._called)
            hint = phrase("`linkwright topic list` and `linkwright topic hz TOPIC` show the published topics")
            found.append(Diagnostic("BAG113", message, severity=Severity.WARNING, hint=hint))
        if self._is_cut_off:
            message = phrase(
                "recording '{path}' is truncated: the recorder was killed, or a copy was interrupted", path=self._called
            )
            hint = phrase("only its complete records are read; the rest is lost")
            found.append(Diagnostic("BAG109", message, severity=Severity.WARNING, hint=hint))
        if self._others:
            message = phrase(
                "topics of '{path}' are left out because their messages are not ROS 2 messages: {topics}",
                path=self._called,
                topics=self._left_out(),
            )
            found.append(Diagnostic("BAG112", message, severity=Severity.WARNING))
        return found

    def _left_out(self) -> str:
        return ", ".join(f"{name} ({form})" for name, form in sorted(self._others.items()))

    @property
    def files(self) -> list[Path]:
        """The files that contain the messages."""
        if self._targets[0].is_file():
            return self._targets
        return _files_in(self.path)

    @property
    def compression(self) -> str:
        """The unit of compression besides chunks: ``file``, ``message``, or an empty string for none."""
        return "file" if self._targets[0].suffix == PACKED else str(self._reader.compression_mode or "")

    @property
    def start_ns(self) -> int:
        """The time of the first message, in nanoseconds since the epoch; 0 if there is none."""
        return self._reader.start_time if self._reader.message_count else 0

    @property
    def end_ns(self) -> int:
        """The time of the last message, in nanoseconds since the epoch; 0 if there is none."""
        return self._reader.end_time - 1 if self._reader.message_count else 0

    @property
    def definitions(self) -> list[tuple[str, str, str, str]]:
        """The definitions of the topics' types: name, ``ros2msg`` or ``ros2idl``, definition and hash."""
        found = {
            connection.msgtype: connection
            for connection in self._reader.connections
            if connection.topic not in self._others
        }
        encodings = {"NONE": "unknown", "MSG": "ros2msg", "IDL": "ros2idl"}
        return [(name, encodings[each.msgdef[0].name], each.msgdef[1], each.digest) for name, each in found.items()]

    def messages(
        self, topics: Collection[str] = (), start_ns: int | None = None, stop_ns: int | None = None
    ) -> Iterator[Recorded]:
        """Yield the topic, the time and the CDR bytes of each message, ordered by time.

        Times are in nanoseconds since the epoch.

        Args:
            topics: the topics to read; empty for all.
            start_ns: the time of the first message to read; None for the beginning.
            stop_ns: the time at which to stop, exclusive; None for the end.

        Raises:
            LinkwrightError: BAG102, the rest cannot be read; BAG103, a topic is not in the recording.
        """
        known = {topic.name for topic in self.topics}
        for name in topics:
            if name not in known:
                hint = did_you_mean(name, known)
                raise LinkwrightError(
                    Diagnostic(
                        "BAG103",
                        phrase("there is no topic '{name}' in '{path}'", name=name, path=self._called),
                        hint=hint,
                    )
                )
        connections = [
            connection
            for connection in self._reader.connections
            if connection.topic not in self._others and (not topics or connection.topic in topics)
        ]
        return self._read(self._reader.messages(connections, start_ns, stop_ns))

    def state_at(self, topics: Collection[str], at_ns: int) -> list[Recorded]:
        """Return the state at a time: the last message of each topic, and transforms; see `Moments`.

        Raises:
            LinkwrightError: BAG102, the messages cannot be read.
        """
        return self._look(lambda: self._moments.state_at(topics, at_ns))

    def time_before(self, topics: Collection[str], at_ns: int) -> int | None:
        """Return the reception time of the last message before a time, or None if there is none.

        Times are in nanoseconds since the epoch.

        Raises:
            LinkwrightError: BAG102, the messages cannot be read.
        """
        return self._look(lambda: self._moments.time_before(topics, at_ns))

    def counts(self, parts: int) -> dict[str, list[int]]:
        """Return the number of messages of each topic in equal parts of the recording's duration.

        The result is empty for a file without an index.
        """
        return self._moments.counts(parts) if self._reader.message_count else {}

    def _look(self, what: Callable[[], T]) -> T:
        try:
            return what()
        except Exception as error:  # a damaged file can make the library raise any exception
            raise _unreadable(self.path, self._called, error) from error

    def _read(self, stream: Iterator[tuple[Any, int, bytes]]) -> Iterator[Recorded]:
        while True:
            try:
                connection, stamp_ns, data = next(stream)
            except StopIteration:
                return
            except Exception as error:
                raise _unreadable(self.path, self._called, error) from error
            yield connection.topic, stamp_ns, data

    def close(self) -> None:
        """Close the files of the recording; a second call has no effect."""
        self._open.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def open_recording(path: str | Path) -> BagReader:
    """Open a recording of topics, in MCAP or SQLite, to read its messages.

    Args:
        path: see `BagReader`. Close the returned reader, or use it in a ``with`` statement.

    Raises:
        LinkwrightError: see `BagReader`.
    """
    return BagReader(path)


def _ignore_profiles_of_files(storage: Any) -> None:
    """Make the library match the topics of ``metadata.yaml`` and of the files despite other profiles.

    Otherwise the library reads no messages from recordings made before rosbag2 stored profiles in files, and from some
    converted ones.
    """
    listed = {(connection.topic, connection.msgtype): connection for connection in storage.connections}
    for file in storage.storages:
        for number, each in enumerate(file.connections):
            known = listed.get((each.topic, each.msgtype), each)
            file.connections[number] = each._replace(ext=known.ext, digest=known.digest)


def _storage_targets(path: Path, called: str) -> list[Path]:
    """Return the paths to pass to the library: the folder, or its files if the metadata are missing."""
    if not path.exists():
        raise LinkwrightError(Diagnostic("BAG101", phrase("there is no recording '{path}'", path=called)))
    if path.is_file() or ((path / METADATA).exists() and not _lacks_ends(path)):
        return [path]
    if not path.is_dir():
        message = phrase("'{path}' is not a recording: it is neither a file nor a folder", path=called)
        raise LinkwrightError(Diagnostic("BAG102", message))
    files = _files_in(path)
    if len(files) == 1 or are_of_one_recording(files):
        return files
    if not files:
        message = phrase(
            "'{path}' is not a recording: it contains neither a metadata.yaml nor recording files", path=called
        )
        raise LinkwrightError(Diagnostic("BAG102", message))
    found = ", ".join(file.name for file in files)
    message = phrase(
        "the files in '{path}' belong to different recordings according to their names: {found}",
        path=called,
        found=found,
    )
    hint = phrase(
        "name one of them; files belong to one recording if their names end with _0, _1, _2, or if "
        "you name them all: linkwright view FILE FILE ..."
    )
    raise LinkwrightError(Diagnostic("BAG102", message, hint=hint))


def _lacks_ends(folder: Path) -> bool:
    """Return whether a recording with metadata consists of several files and one is unfinished."""
    files = sorted(folder.glob("*.mcap"))
    return len(files) > 1 and are_of_one_recording(files) and any(is_unfinished(file) for file in files)


def _storage_of(target: Path) -> str:
    if target.is_file():
        return storage_of(target) or target.suffix.lstrip(".")
    return next((name for path in _files_in(target) if (name := storage_of(path)) is not None), "")


def _files_in(folder: Path) -> list[Path]:
    return sorted(path for path in folder.iterdir() if storage_of(path) is not None)


def _format_of(connection: Any) -> str:
    return str(getattr(connection.ext, "serialization_format", _OURS))


def _profiles(connection: Any) -> list[Any]:
    return list(getattr(connection.ext, "offered_qos_profiles", ()))


def _unreadable(path: Path, called: str, error: Exception) -> LinkwrightError:
    reason, hint, note = diagnose(path, error)
    return LinkwrightError(
        Diagnostic(
            "BAG102",
            phrase("'{path}' cannot be read as a recording: {reason}", path=called, reason=reason),
            notes=() if note is None else (Note(note),),
            hint=hint,
        )
    )
