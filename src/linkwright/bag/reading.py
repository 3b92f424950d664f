"""Read a recording: its topics, and its messages ordered by time."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.bag.moments import StateLookup
from linkwright.bag.names import COMPRESSED_SUFFIX, METADATA_FILE, Recorded, belong_together, find_storage_format
from linkwright.bag.qos import from_library
from linkwright.bag.scratch import create_scratch_folder
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

_ROS_FORMAT = "cdr"
"""The serialization format of ROS 2 messages. Topics with another format are left out."""


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
    """An open recording.

    Close it, or use it in a ``with`` statement. Unknown message types are registered from the definitions in the
    recording.

    Args:
        path: a folder with a ``metadata.yaml``, or a single ``.mcap`` or ``.db3`` file. If the recorder was killed, and
            ``metadata.yaml`` and the index are missing, all complete messages are read. A folder can also contain
            only the numbered files of one recording.
        display_name: the name of the recording in messages to the user; None for its path.
        files: the files of the recording, with any names, if several files are read as one recording; else empty.

    Raises:
        LinkwrightError: BAG101, the path does not exist; BAG102, the path is not a recording, or the recording is
            damaged; BAG107, `rosbags` is not installed.
    """

    def __init__(self, path: str | Path, display_name: str | None = None, files: Sequence[Path] = ()) -> None:
        try:
            import rosbags.rosbag2  # noqa: F401  # whether it is installed
        except ModuleNotFoundError as error:
            raise missing_extra("BAG107", error) from None
        self.path = Path(path)
        self._display_name = display_path(self.path) if display_name is None else display_name
        self._open = ExitStack()
        self._is_truncated = False
        self._targets = list(files) or _find_storage_targets(self.path, self._display_name)
        try:
            self._reader = self._open_reader(self._targets)
        except BaseException:
            self._open.close()
            raise
        self.storage = _find_target_storage(self._targets[0])
        self._state_lookup = StateLookup(self._reader)
        self._register_types()
        self._other_formats = {
            connection.topic: serialization_format or "?"
            for connection in self._reader.connections
            if (serialization_format := _get_serialization_format(connection)) != _ROS_FORMAT
        }
        self.topics = [
            BagTopic(
                name,
                info.msgtype or "",
                info.msgcount,
                _get_serialization_format(info.connections[0]),
                tuple(
                    from_library(qos) for connection in info.connections for qos in _get_offered_profiles(connection)
                ),
            )
            for name, info in self._reader.topics.items()
            if name not in self._other_formats
        ]
        if self._other_formats and not self.topics:
            self.close()
            message = phrase(
                "'{path}' is not a ROS 2 recording: {topics}",
                path=self._display_name,
                topics=self._describe_other_formats(),
            )
            raise LinkwrightError(
                Diagnostic("BAG102", message, hint=phrase("the encoding of each topic's messages is in brackets"))
            )

    def _open_reader(self, targets: Sequence[Path]) -> Reader:
        if len(targets) == 1:
            return self._open_target(targets[0], self.path, self._display_name)
        from linkwright.bag.several import SeveralReader

        # A file is empty if the recorder is killed right after creating it.
        nonempty = [target for target in targets if target.stat().st_size] or targets
        self._is_truncated = len(nonempty) < len(targets)
        return SeveralReader([self._open_target(path, path, path.name) for path in nonempty])

    def _open_target(self, target: Path, path: Path, display_name: str) -> Reader:
        from rosbags.rosbag2 import Reader

        try:
            reader = Reader(self._make_readable(target))
            reader.open()
            self._open.callback(reader.close)
            if hasattr(reader.storage, "storages"):
                _ignore_profiles_of_files(reader.storage)
            if target.is_file():
                from linkwright.bag.packed import decompress_messages

                decompress_messages(reader)
        except Exception as error:  # a damaged file can make the library raise any exception
            raise _unreadable_error(path, display_name, error) from error
        return reader

    def _make_readable(self, target: Path) -> Any:
        """Return a target that the library can open: the path, or an indexed file in memory.

        Data that the library would reject are removed from the file in memory.
        """
        if target.is_file() and target.suffix == COMPRESSED_SUFFIX:
            from linkwright.bag.packed import decompress_file

            target = decompress_file(target, Path(self._open.enter_context(create_scratch_folder())))
        files = sorted(target.glob("*.mcap")) if target.is_dir() else [target]
        if len(files) != 1 or files[0].suffix != ".mcap":
            return target
        self._is_truncated = self._is_truncated or is_unfinished(files[0])
        return make_readable(files[0]) or target

    def _register_types(self) -> None:
        from rosbags.interfaces import MessageDefinitionFormat

        origin = self._display_name
        for connection in self._reader.connections:
            definition_format, text = connection.msgdef
            if definition_format is not MessageDefinitionFormat.NONE:
                add_definitions(connection.msgtype, text, origin, idl=definition_format is MessageDefinitionFormat.IDL)

    @property
    def findings(self) -> list[Diagnostic]:
        """The diagnostics about the recording.

        They report a truncated recording, because the recorder was killed or a copy was interrupted (BAG109), topics
        with messages of other systems (BAG112), and a recording without messages (BAG113).
        """
        diagnostics = []
        if not self._is_truncated and not any(topic.count for topic in self.topics):
            message = phrase("recording '{path}' contains no messages", path=self._display_name)
            hint = phrase("run `linkwright topic list` or `linkwright topic hz TOPIC` to see the published topics")
            diagnostics.append(Diagnostic("BAG113", message, severity=Severity.WARNING, hint=hint))
        if self._is_truncated:
            message = phrase(
                "recording '{path}' is truncated: the recorder was killed, or a copy was interrupted",
                path=self._display_name,
            )
            hint = phrase("only its complete records are read; the rest is lost")
            diagnostics.append(Diagnostic("BAG109", message, severity=Severity.WARNING, hint=hint))
        if self._other_formats:
            message = phrase(
                "topics of '{path}' are left out because their messages are not ROS 2 messages: {topics}",
                path=self._display_name,
                topics=self._describe_other_formats(),
            )
            diagnostics.append(Diagnostic("BAG112", message, severity=Severity.WARNING))
        return diagnostics

    def _describe_other_formats(self) -> str:
        return ", ".join(
            f"{name} ({serialization_format})" for name, serialization_format in sorted(self._other_formats.items())
        )

    @property
    def files(self) -> list[Path]:
        """The files that contain the messages."""
        if self._targets[0].is_file():
            return self._targets
        return _find_recording_files(self.path)

    @property
    def compression(self) -> str:
        """The unit of compression besides chunks: ``file``, ``message``, or empty for none."""
        return "file" if self._targets[0].suffix == COMPRESSED_SUFFIX else str(self._reader.compression_mode or "")

    @property
    def start_ns(self) -> int:
        """The time of the first message, in nanoseconds since the epoch, or 0 without messages."""
        return self._reader.start_time if self._reader.message_count else 0

    @property
    def end_ns(self) -> int:
        """The time of the last message, in nanoseconds since the epoch, or 0 without messages."""
        return self._reader.end_time - 1 if self._reader.message_count else 0

    @property
    def definitions(self) -> list[tuple[str, str, str, str]]:
        """The definitions of the topics' types: type name, encoding, text and hash.

        The encoding is ``ros2msg``, ``ros2idl`` or ``unknown``.
        """
        connections_by_type = {
            connection.msgtype: connection
            for connection in self._reader.connections
            if connection.topic not in self._other_formats
        }
        encodings = {"NONE": "unknown", "MSG": "ros2msg", "IDL": "ros2idl"}
        return [
            (name, encodings[connection.msgdef[0].name], connection.msgdef[1], connection.digest)
            for name, connection in connections_by_type.items()
        ]

    def messages(
        self, topics: Collection[str] = (), start_ns: int | None = None, stop_ns: int | None = None
    ) -> Iterator[Recorded]:
        """Yield the topic, the reception time and the data of each message, ordered by time.

        Times are in nanoseconds since the epoch.

        Args:
            topics: the topics to read; empty for all.
            start_ns: the time of the first message to read; None for the beginning.
            stop_ns: the time at which to stop, exclusive; None for the end.

        Raises:
            LinkwrightError: BAG102, further messages cannot be read; BAG103, a topic is not in the recording.
        """
        topic_names = {topic.name for topic in self.topics}
        for name in topics:
            if name not in topic_names:
                hint = did_you_mean(name, topic_names)
                raise LinkwrightError(
                    Diagnostic(
                        "BAG103",
                        phrase("there is no topic '{name}' in '{path}'", name=name, path=self._display_name),
                        hint=hint,
                    )
                )
        connections = [
            connection
            for connection in self._reader.connections
            if connection.topic not in self._other_formats and (not topics or connection.topic in topics)
        ]
        return self._read(self._reader.messages(connections, start_ns, stop_ns))

    def state_at(self, topics: Collection[str], at_ns: int) -> list[Recorded]:
        """Return the state at a time: the last message of each topic, and the transforms.

        See `StateLookup`.

        Raises:
            LinkwrightError: BAG102, the messages cannot be read.
        """
        return self._search(lambda: self._state_lookup.state_at(topics, at_ns))

    def time_before(self, topics: Collection[str], at_ns: int) -> int | None:
        """Return the reception time of the last message before a time, or None.

        Times are in nanoseconds since the epoch.

        Raises:
            LinkwrightError: BAG102, the messages cannot be read.
        """
        return self._search(lambda: self._state_lookup.time_before(topics, at_ns))

    def counts(self, intervals: int) -> dict[str, list[int]]:
        """Return the number of messages of each topic in equal intervals of the recording.

        The result is empty for a file without an index.
        """
        return self._state_lookup.counts(intervals) if self._reader.message_count else {}

    def _search(self, search: Callable[[], T]) -> T:
        try:
            return search()
        except Exception as error:  # a damaged file can make the library raise any exception
            raise _unreadable_error(self.path, self._display_name, error) from error

    def _read(self, stream: Iterator[tuple[Any, int, bytes]]) -> Iterator[Recorded]:
        while True:
            try:
                connection, stamp_ns, data = next(stream)
            except StopIteration:
                return
            except Exception as error:
                raise _unreadable_error(self.path, self._display_name, error) from error
            yield connection.topic, stamp_ns, data

    def close(self) -> None:
        """Close the files of the recording.

        A second call has no effect.
        """
        self._open.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def open_recording(path: str | Path) -> BagReader:
    """Open a recording in MCAP or SQLite to read its messages.

    The caller must close the returned reader, or use it in a ``with`` statement.

    Args:
        path: see `BagReader`.

    Raises:
        LinkwrightError: see `BagReader`.
    """
    return BagReader(path)


def _ignore_profiles_of_files(storage: Any) -> None:
    """Let the library match topics of ``metadata.yaml`` and of the files regardless of QoS.

    Otherwise it reads no messages from recordings made before rosbag2 stored profiles in files, and from some
    converted recordings.
    """
    listed_connections = {(connection.topic, connection.msgtype): connection for connection in storage.connections}
    for file in storage.storages:
        for index, connection in enumerate(file.connections):
            listed_connection = listed_connections.get((connection.topic, connection.msgtype), connection)
            file.connections[index] = connection._replace(ext=listed_connection.ext, digest=listed_connection.digest)


def _find_storage_targets(path: Path, display_name: str) -> list[Path]:
    """Return the paths that the library opens.

    These are the folder, or its files if the metadata is missing.
    """
    if not path.exists():
        raise LinkwrightError(Diagnostic("BAG101", phrase("there is no recording '{path}'", path=display_name)))
    if path.is_file() or ((path / METADATA_FILE).exists() and not _has_unfinished_file(path)):
        return [path]
    if not path.is_dir():
        message = phrase("'{path}' is not a recording: it is neither a file nor a folder", path=display_name)
        raise LinkwrightError(Diagnostic("BAG102", message))
    files = _find_recording_files(path)
    if len(files) == 1 or belong_together(files):
        return files
    if not files:
        message = phrase(
            "'{path}' is not a recording: it contains neither a metadata.yaml nor recording files", path=display_name
        )
        raise LinkwrightError(Diagnostic("BAG102", message))
    file_names = ", ".join(file.name for file in files)
    message = phrase(
        "the names of the files in '{path}' show that they belong to different recordings: {files}",
        path=display_name,
        files=file_names,
    )
    hint = phrase("pass one of them, or all files of one recording: linkwright view FILE FILE ...")
    raise LinkwrightError(Diagnostic("BAG102", message, hint=hint))


def _has_unfinished_file(folder: Path) -> bool:
    """Return whether one of several files of a recording with metadata is unfinished."""
    files = sorted(folder.glob("*.mcap"))
    return len(files) > 1 and belong_together(files) and any(is_unfinished(file) for file in files)


def _find_target_storage(target: Path) -> str:
    if target.is_file():
        return find_storage_format(target) or target.suffix.lstrip(".")
    return next((name for path in _find_recording_files(target) if (name := find_storage_format(path)) is not None), "")


def _find_recording_files(folder: Path) -> list[Path]:
    return sorted(path for path in folder.iterdir() if find_storage_format(path) is not None)


def _get_serialization_format(connection: Any) -> str:
    return str(getattr(connection.ext, "serialization_format", _ROS_FORMAT))


def _get_offered_profiles(connection: Any) -> list[Any]:
    return list(getattr(connection.ext, "offered_qos_profiles", ()))


def _unreadable_error(path: Path, display_name: str, error: Exception) -> LinkwrightError:
    reason, hint, note = diagnose(path, error)
    return LinkwrightError(
        Diagnostic(
            "BAG102",
            phrase("'{path}' cannot be read as a recording: {reason}", path=display_name, reason=reason),
            notes=() if note is None else (Note(note),),
            hint=hint,
        )
    )
