"""Recordings, read and written message by message (the API of ``rosbag2_py``, of Humble to Kilted)."""

from __future__ import annotations

import enum
import re
import weakref
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from linkwright.bag import STORAGES, BagReader, BagWriter
from linkwright.diagnostics import LinkwrightError
from linkwright.graph.qos.profile import QoSProfile
from linkwright.graph.time.values import ClockType, Duration, Time


@dataclass
class StorageOptions:
    """Where a recording is, in which format, and how it is divided into files."""

    uri: str
    storage_id: str = ""
    max_bagfile_size: int = 0
    max_bagfile_duration: int = 0
    max_cache_size: int = 0
    storage_preset_profile: str = ""
    storage_config_uri: str = ""
    snapshot_mode: bool = False
    start_time_ns: int = -1
    end_time_ns: int = -1
    custom_data: dict[str, str] = field(default_factory=dict)


@dataclass
class ConverterOptions:
    """The formats of messages; CDR is the only one."""

    input_serialization_format: str = ""
    output_serialization_format: str = ""


@dataclass
class StorageFilter:
    """Which topics are read: those named and those that match a regular expression; all where neither is given."""

    topics: list[str] = field(default_factory=list)
    topics_regex: str = ""
    topics_regex_to_exclude: str = ""
    regex: str = ""
    exclude_topics: list[str] = field(default_factory=list)

    def admits(self, topic: str) -> bool:
        """Whether a topic is read."""
        pattern = self.regex or self.topics_regex
        wanted = not (self.topics or pattern) or topic in self.topics or bool(pattern and re.search(pattern, topic))
        left_out = self.topics_regex_to_exclude and re.search(self.topics_regex_to_exclude, topic)
        return wanted and not left_out and topic not in self.exclude_topics


@dataclass
class TopicMetadata:
    """A topic of a recording.

    Humble has no ``id``, and one text instead of a list of profiles, so all but the name are better given by keyword.
    """

    id: int = 0
    name: str = ""
    type: str = ""
    serialization_format: str = "cdr"
    offered_qos_profiles: Sequence[QoSProfile] | str = ()
    type_description_hash: str = ""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        names = ["id", "name", "type", "serialization_format", "offered_qos_profiles", "type_description_hash"]
        if args and isinstance(args[0], str):
            names.remove("id")
        given = dict(zip(names, args, strict=False)) | kwargs
        unknown = given.keys() - {"id", *names}
        if unknown or len(args) > len(names):
            raise TypeError(f"TopicMetadata() got unexpected arguments: {', '.join(sorted(unknown)) or args}")
        for name, value in given.items():
            setattr(self, name, value)

    def equals(self, other: TopicMetadata) -> bool:
        """Whether another is the same."""
        return self == other


@dataclass(frozen=True)
class TopicInformation:
    """A topic with the number of its messages."""

    topic_metadata: TopicMetadata
    message_count: int


@dataclass(frozen=True)
class BagMetadata:
    """What is known of a recording without reading its messages."""

    storage_identifier: str
    relative_file_paths: list[str]
    bag_size: int
    starting_time: Time
    duration: Duration
    message_count: int
    topics_with_message_count: list[TopicInformation]


class CompressionMode(enum.Enum):
    """What is compressed."""

    NONE = 0
    FILE = 1
    MESSAGE = 2


@dataclass
class CompressionOptions:
    """How a recording is compressed; zstd is the only format, and there is nothing to be tuned."""

    compression_format: str = ""
    compression_mode: CompressionMode = CompressionMode.NONE
    compression_queue_size: int = 1
    compression_threads: int = 0
    thread_priority: int | None = None


def compression_mode_from_string(name: str) -> CompressionMode:
    """The mode that a name means, in any case; none for an unknown one."""
    return CompressionMode.__members__.get(name.upper(), CompressionMode.NONE)


def compression_mode_to_string(mode: CompressionMode) -> str:
    """The name of a mode."""
    return mode.name


class SequentialReader:
    """Reads messages in the order of their times."""

    def __init__(self) -> None:
        self._bag: BagReader | None = None
        self._filter = StorageFilter()
        self._stream: Iterator[tuple[str, int, bytes]] = iter(())
        self._next: tuple[str, int, bytes] | None = None

    def open(self, storage_options: StorageOptions, converter_options: ConverterOptions | None = None) -> None:
        """Open a recording: a folder, or a single file.

        Raises:
            RuntimeError: there is none, or it is damaged.
        """
        try:
            self._bag = BagReader(storage_options.uri)
        except LinkwrightError as error:
            raise RuntimeError(str(error)) from error
        weakref.finalize(self, self._bag.close)
        self._begin()

    def open_uri(self, uri: str) -> None:
        """Open a recording by its place alone."""
        self.open(StorageOptions(uri))

    def close(self) -> None:
        """Close its files."""
        self._opened().close()

    def has_next(self) -> bool:
        """Whether there is another message."""
        return self._next is not None

    def read_next(self) -> tuple[str, bytes, int]:
        """The next message: topic, CDR bytes, and when it was received, in nanoseconds since the epoch.

        Raises:
            RuntimeError: there is none.
        """
        if self._next is None:
            raise RuntimeError("Bag is at end. No next message.")
        topic, stamp_ns, data = self._next
        self._advance()
        return topic, data, stamp_ns

    def get_all_topics_and_types(self) -> list[TopicMetadata]:
        """The topics of the recording, whatever is filtered."""
        return [each.topic_metadata for each in self.get_metadata().topics_with_message_count]

    def get_metadata(self) -> BagMetadata:
        """What is known of the recording."""
        bag = self._opened()
        topics = [
            TopicInformation(
                TopicMetadata(
                    id=number,
                    name=topic.name,
                    type=topic.type_name,
                    serialization_format=topic.serialization_format,
                    offered_qos_profiles=list(topic.offered_qos),
                ),
                topic.count,
            )
            for number, topic in enumerate(bag.topics, 1)
        ]
        return BagMetadata(
            bag.storage,
            [file.name for file in bag.files],
            sum(file.stat().st_size for file in bag.files),
            Time(nanoseconds=bag.start_ns, clock_type=ClockType.SYSTEM_TIME),
            Duration(nanoseconds=bag.end_ns - bag.start_ns),
            sum(topic.count for topic in bag.topics),
            topics,
        )

    def set_filter(self, storage_filter: StorageFilter) -> None:
        """Read only some topics from here on."""
        self._filter = storage_filter
        self._begin(None if self._next is None else self._next[1])

    def reset_filter(self) -> None:
        """Read all topics from here on."""
        self.set_filter(StorageFilter())

    def seek(self, timestamp: int) -> None:
        """Continue with the first message at or after a time, in nanoseconds since the epoch."""
        self._begin(timestamp)

    def _opened(self) -> BagReader:
        if self._bag is None:
            raise RuntimeError("Bag is not open. Call open() before reading.")
        return self._bag

    def _begin(self, start_ns: int | None = None) -> None:
        bag = self._opened()
        topics = [topic.name for topic in bag.topics if self._filter.admits(topic.name)]
        self._stream = bag.messages(topics, start_ns) if topics else iter(())
        self._advance()

    def _advance(self) -> None:
        try:
            self._next = next(self._stream, None)
        except LinkwrightError as error:
            self._next = None
            raise RuntimeError(str(error)) from error


class SequentialWriter:
    """Writes messages. The recording is complete once this is closed or garbage collected."""

    def __init__(self) -> None:
        self._bag: BagWriter | None = None

    def open(self, storage_options: StorageOptions, converter_options: ConverterOptions | None = None) -> None:
        """Begin a recording.

        Raises:
            RuntimeError: the folder exists already, or there is no such storage.
        """
        try:
            self._bag = writer_for(storage_options, self._compression(storage_options))
        except LinkwrightError as error:
            raise RuntimeError(str(error)) from error
        weakref.finalize(self, self._bag.close)

    def close(self) -> None:
        """Finish the recording."""
        self._opened().close()

    def create_topic(self, topic_with_type: TopicMetadata) -> None:
        """Make room for a topic; its messages may follow.

        Raises:
            RuntimeError: no package has its type.
        """
        profiles = topic_with_type.offered_qos_profiles
        try:
            self._opened().add_topic(
                topic_with_type.name, topic_with_type.type, () if isinstance(profiles, str) else profiles
            )
        except LinkwrightError as error:
            raise RuntimeError(str(error)) from error

    def write(self, topic_name: str, message: bytes, timestamp: int) -> None:
        """Add a message.

        Args:
            topic_name: a topic that was made.
            message: CDR bytes with their header, as ``serialize_message`` gives them.
            timestamp: when it was received, nanoseconds since the epoch.

        Raises:
            RuntimeError: there is no such topic.
        """
        bag = self._opened()
        if topic_name not in bag.topics:
            raise RuntimeError(f"Topic '{topic_name}' has not been created yet! Call 'create_topic' first.")
        bag.write(topic_name, timestamp, message)

    def take_snapshot(self) -> bool:
        """Write the last messages, which are kept with ``snapshot_mode``; whether they are.

        Raises:
            RuntimeError: the disk refuses.
        """
        try:
            return self._opened().take_snapshot()
        except LinkwrightError as error:
            raise RuntimeError(str(error)) from error

    def split_bagfile(self) -> None:
        """Go on in another file.

        Raises:
            RuntimeError: the disk refuses.
        """
        try:
            self._opened().split()
        except LinkwrightError as error:
            raise RuntimeError(str(error)) from error

    def _compression(self, storage_options: StorageOptions) -> str:
        return "none"

    def _opened(self) -> BagWriter:
        if self._bag is None:
            raise RuntimeError("Bag is not open. Call open() before writing.")
        return self._bag


class SequentialCompressionWriter(SequentialWriter):
    """A `SequentialWriter` of compressed recordings; without options, where the format has compression."""

    def __init__(self, compression_options: CompressionOptions | None = None) -> None:
        super().__init__()
        self._options = compression_options

    def _compression(self, storage_options: StorageOptions) -> str:
        if self._options is None:
            return "storage" if storage_options.storage_id != "sqlite3" else "none"
        return self._options.compression_mode.name


class Info:
    """Answers questions about recordings."""

    def read_metadata(self, uri: str, storage_id: str = "") -> BagMetadata:
        """What is known of a recording.

        Raises:
            RuntimeError: there is none, or it is damaged.
        """
        reader = SequentialReader()
        reader.open(StorageOptions(uri))
        try:
            return reader.get_metadata()
        finally:
            reader.close()


def get_registered_readers() -> set[str]:
    """The formats of files that can be read."""
    return set(STORAGES)


def get_default_storage_id() -> str:
    """The format of the files that are written where none is named."""
    return STORAGES[0]


def get_registered_compressors() -> set[str]:
    """The formats of compression."""
    return {"zstd"}


def get_registered_serializers() -> set[str]:
    """The converters of messages: none, since CDR is the only form."""
    return set()


def get_registered_writers() -> set[str]:
    """The formats of files that can be written."""
    return set(STORAGES)


def writer_for(options: StorageOptions, compression: str) -> BagWriter:
    """A recording by its options.

    Raises:
        RuntimeError: there is no such storage, or there is no room for snapshots.
        LinkwrightError: those of `BagWriter`.
    """
    storage = options.storage_id or STORAGES[0]
    if storage not in STORAGES:
        raise RuntimeError(f"No storage could be initialized from the inputs: no storage '{storage}'")
    if options.snapshot_mode and options.max_cache_size <= 0:
        raise RuntimeError("Max cache size must be greater than 0 when snapshot mode is enabled")
    return BagWriter(
        options.uri,
        storage,
        compression=compression.lower() or "none",
        max_size=options.max_bagfile_size,
        max_seconds=options.max_bagfile_duration,
        snapshot_size=options.max_cache_size if options.snapshot_mode else 0,
        custom_data=options.custom_data,
    )
