"""Readers and writers of recordings (the API of ``rosbag2_py`` from Humble to Kilted)."""

from __future__ import annotations

import enum
import weakref
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import chain

from linkwright.bag import STORAGES, BagReader, BagWriter
from linkwright.diagnostics import LinkwrightError
from linkwright.graph.time.values import ClockType, Duration, Time
from linkwright.messages import type_hash
from linkwright.messages.schema_text import schema_of
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.standins.recording_storage import (
    BagMetadata,
    ConverterOptions,
    FileInformation,
    MessageDefinition,
    MetadataIo,
    ReadOrder,
    ReadOrderSortBy,
    StorageFilter,
    StorageOptions,
    TopicInformation,
    TopicMetadata,
)

_Message = tuple[str, int, bytes]

_BLOCK_DURATION_NS = NANOSECONDS_PER_SECOND
"""The duration in nanoseconds of the block that is loaded at a time when messages are read backwards."""


class CompressionMode(enum.Enum):
    """The unit that is compressed: none, a file or a message."""

    NONE = 0
    FILE = 1
    MESSAGE = 2


@dataclass
class CompressionOptions:
    """The compression options.

    Only zstd is supported. Performance options are ignored.
    """

    compression_format: str = ""
    compression_mode: CompressionMode = CompressionMode.NONE
    compression_queue_size: int = 1
    compression_threads: int = 0
    thread_priority: int | None = None


def compression_mode_from_string(name: str) -> CompressionMode:
    """Return the mode with a name, ignoring case, or NONE if there is no such mode."""
    return CompressionMode.__members__.get(name.upper(), CompressionMode.NONE)


def compression_mode_to_string(mode: CompressionMode) -> str:
    """Return the name of a compression mode."""
    return mode.name


class SequentialReader:
    """A reader of messages in the order of their timestamps."""

    def __init__(self) -> None:
        self._bag: BagReader | None = None
        self._filter = StorageFilter()
        self._reverse = False
        self._start_ns: int | None = None
        self._last: _Message | None = None
        self._stream: Iterator[_Message] = iter(())
        self._next: _Message | None = None

    def open(self, storage_options: StorageOptions, converter_options: ConverterOptions | None = None) -> None:
        """Open a recording: a folder, or a single file.

        Raises:
            RuntimeError: there is no such recording, or it is damaged.
        """
        try:
            self._bag = BagReader(storage_options.uri)
        except LinkwrightError as error:
            raise RuntimeError(str(error)) from error
        weakref.finalize(self, self._bag.close)
        self.seek(None)

    def open_uri(self, uri: str) -> None:
        """Open a recording, given its path, with default options."""
        self.open(StorageOptions(uri))

    def close(self) -> None:
        """Close the files of the recording."""
        self._open_bag().close()

    def has_next(self) -> bool:
        """Return whether there is another message."""
        return self._next is not None

    def read_next(self) -> tuple[str, bytes, int]:
        """Return the topic, the CDR bytes and the time of reception of the next message.

        The time is in nanoseconds since the epoch.

        Raises:
            RuntimeError: there is no further message.
        """
        if self._next is None:
            raise RuntimeError("Bag is at end. No next message.")
        topic, stamp_ns, data = self._last = self._next
        self._advance()
        return topic, data, stamp_ns

    def get_all_topics_and_types(self) -> list[TopicMetadata]:
        """Return the topics of the recording, including topics that the filter excludes."""
        return [topic_information.topic_metadata for topic_information in self.get_metadata().topics_with_message_count]

    def get_all_message_definitions(self) -> list[MessageDefinition]:
        """Return the type definitions that the recording contains for its topics."""
        return [MessageDefinition(*definition) for definition in self._open_bag().definitions]

    def get_metadata(self) -> BagMetadata:
        """Return the metadata of the recording."""
        bag = self._open_bag()
        hashes = {name: digest for name, _, _, digest in bag.definitions}
        topics = [
            TopicInformation(
                TopicMetadata(
                    id=number,
                    name=topic.name,
                    type=topic.type_name,
                    serialization_format=topic.serialization_format,
                    offered_qos_profiles=list(topic.offered_qos),
                    type_description_hash=hashes[topic.type_name],
                ),
                topic.count,
            )
            for number, topic in enumerate(bag.topics, 1)
        ]
        start, duration = _to_time(bag.start_ns), Duration(nanoseconds=bag.end_ns - bag.start_ns)
        files, count = [file.name for file in bag.files], sum(topic.count for topic in bag.topics)
        return BagMetadata(
            storage_identifier=bag.storage,
            relative_file_paths=files,
            files=[FileInformation(files[0], start, duration, count)] if len(files) == 1 else _read_files(bag),
            bag_size=sum(file.stat().st_size for file in bag.files),
            starting_time=start,
            duration=duration,
            message_count=count,
            topics_with_message_count=topics,
            compression_format="zstd" if bag.compression else "",
            compression_mode=bag.compression,
        )

    def set_filter(self, storage_filter: StorageFilter) -> None:
        """Restrict further reading to the topics that a filter includes."""
        self._filter = storage_filter
        self._open_stream()

    def reset_filter(self) -> None:
        """Remove the filter, so that further reading returns all topics."""
        self.set_filter(StorageFilter())

    def set_read_order(self, read_order: ReadOrder) -> bool:
        """Set the direction of further reading: forwards or backwards.

        Returns:
            Whether the order is supported.

        Raises:
            RuntimeError: the order is not by the time of reception.
        """
        if read_order.sort_by is not ReadOrderSortBy.ReceivedTimestamp:
            raise RuntimeError(f"Not Implemented - {read_order.sort_by.name} read order")
        self._reverse = read_order.reverse
        self._open_stream()
        return True

    def seek(self, timestamp: int | None) -> None:
        """Set the position to a time in nanoseconds since the epoch.

        The next message is the first one at or after this time. When reading backwards, it is the last one at or before
        this time.
        """
        self._start_ns, self._last = timestamp, None
        self._open_stream()

    def _open_bag(self) -> BagReader:
        if self._bag is None:
            raise RuntimeError("Bag is not open. Call open() before reading.")
        return self._bag

    def _open_stream(self) -> None:
        """Open the stream of messages after the last message that was read."""
        bag = self._open_bag()
        topics = [topic.name for topic in bag.topics if self._filter.admits(topic.name)]
        if not topics:
            self._stream = iter(())
        elif self._last is None:
            self._stream = self._read_messages_from(topics, self._start_ns)
        else:
            stamp_ns = self._last[1]
            same_stamp_messages = list(bag.messages((), stamp_ns, stamp_ns + 1))
            if self._reverse:
                same_stamp_messages.reverse()
            remaining_messages = [
                message
                for message in same_stamp_messages[same_stamp_messages.index(self._last) + 1 :]
                if message[0] in topics
            ]
            self._stream = chain(
                remaining_messages, self._read_messages_from(topics, stamp_ns + (-1 if self._reverse else 1))
            )
        self._advance()

    def _read_messages_from(self, topics: Collection[str], stamp_ns: int | None) -> Iterator[_Message]:
        if self._reverse:
            return _read_backwards(self._open_bag(), topics, stamp_ns)
        return self._open_bag().messages(topics, stamp_ns)

    def _advance(self) -> None:
        try:
            self._next = next(self._stream, None)
        except LinkwrightError as error:
            self._next = None
            raise RuntimeError(str(error)) from error


def _read_backwards(bag: BagReader, topics: Collection[str], last_ns: int | None) -> Iterator[_Message]:
    """Yield the messages of topics in reverse order, from the last one at or before `last_ns`.

    If `last_ns` is None, begin at the end of the recording.
    """
    stop_ns, step_ns = (bag.end_ns if last_ns is None else min(last_ns, bag.end_ns)) + 1, _BLOCK_DURATION_NS
    while stop_ns > bag.start_ns:
        messages = list(bag.messages(topics, stop_ns - step_ns, stop_ns))
        yield from reversed(messages)
        stop_ns -= step_ns
        step_ns = _BLOCK_DURATION_NS if messages else 2 * step_ns


def _read_files(bag: BagReader) -> list[FileInformation]:
    """Return the files that the ``metadata.yaml`` of a recording lists.

    Without a ``metadata.yaml``, the list is empty.
    """
    metadata = MetadataIo()
    path = str(bag.path)
    return metadata.read_metadata(path).files if metadata.metadata_file_exists(path) else []


def _to_time(stamp_ns: int) -> Time:
    return Time(nanoseconds=stamp_ns, clock_type=ClockType.SYSTEM_TIME)


class SequentialWriter:
    """A writer of recordings.

    The recording is complete after the writer is closed or garbage collected.
    """

    def __init__(self) -> None:
        self._bag: BagWriter | None = None

    def open(self, storage_options: StorageOptions, converter_options: ConverterOptions | None = None) -> None:
        """Create a recording.

        Raises:
            RuntimeError: the folder already exists, or there is no such storage.
        """
        try:
            self._bag = create_writer(storage_options, self._choose_compression(storage_options))
        except LinkwrightError as error:
            raise RuntimeError(str(error)) from error
        weakref.finalize(self, self._bag.close)

    def close(self) -> None:
        """Finish the recording."""
        self._open_bag().close()

    def create_topic(self, topic_with_type: TopicMetadata) -> None:
        """Add a topic, so that messages of the topic can be written.

        Raises:
            RuntimeError: no package defines the topic's type.
        """
        profiles = topic_with_type.offered_qos_profiles
        try:
            self._open_bag().add_topic(
                topic_with_type.name, topic_with_type.type, () if isinstance(profiles, str) else profiles
            )
        except LinkwrightError as error:
            raise RuntimeError(str(error)) from error

    def write(self, topic_name: str, message: bytes, timestamp: int, send_timestamp: int | None = None) -> None:
        """Write a message.

        Args:
            topic_name: a topic from `create_topic`.
            message: CDR bytes including the encapsulation header, from ``serialize_message``.
            timestamp: the time of reception, in nanoseconds since the epoch.
            send_timestamp: the time of publication, which is not recorded.

        Raises:
            RuntimeError: there is no such topic.
        """
        bag = self._open_bag()
        if topic_name not in bag.topics:
            raise RuntimeError(f"Topic '{topic_name}' has not been created yet! Call 'create_topic' first.")
        bag.write(topic_name, timestamp, message)

    def take_snapshot(self) -> bool:
        """Write the buffered messages to the recording.

        Returns:
            Whether ``snapshot_mode`` is on; otherwise messages are not buffered.

        Raises:
            RuntimeError: the file cannot be written.
        """
        try:
            return self._open_bag().take_snapshot()
        except LinkwrightError as error:
            raise RuntimeError(str(error)) from error

    def split_bagfile(self) -> None:
        """Start a new file for further messages.

        Raises:
            RuntimeError: the file cannot be written.
        """
        try:
            self._open_bag().split()
        except LinkwrightError as error:
            raise RuntimeError(str(error)) from error

    def _choose_compression(self, storage_options: StorageOptions) -> str:
        return "none"

    def _open_bag(self) -> BagWriter:
        if self._bag is None:
            raise RuntimeError("Bag is not open. Call open() before writing.")
        return self._bag


class SequentialCompressionWriter(SequentialWriter):
    """A `SequentialWriter` for compressed recordings.

    Without options, the compression of the storage format is used.
    """

    def __init__(self, compression_options: CompressionOptions | None = None) -> None:
        super().__init__()
        self._options = compression_options

    def _choose_compression(self, storage_options: StorageOptions) -> str:
        if self._options is None:
            return "storage" if storage_options.storage_id != "sqlite3" else "none"
        return self._options.compression_mode.name


class Info:
    """A reader of the metadata of recordings."""

    def read_metadata(self, uri: str, storage_id: str = "") -> BagMetadata:
        """Return the metadata of a recording.

        Raises:
            RuntimeError: there is no such recording, or it is damaged.
        """
        reader = SequentialReader()
        reader.open(StorageOptions(uri))
        try:
            return reader.get_metadata()
        finally:
            reader.close()


class LocalMessageDefinitionSource:
    """A source of the definitions of message types."""

    def get_full_text(self, root_topic_type: str) -> MessageDefinition:
        """Return the definition of a type.

        The definition of an unknown type is empty.
        """
        try:
            return MessageDefinition(root_topic_type, "ros2msg", schema_of(root_topic_type), type_hash(root_topic_type))
        except LinkwrightError:
            return MessageDefinition(root_topic_type, "unknown", "", "")


def get_registered_readers() -> set[str]:
    """Return the storage formats that can be read."""
    return set(STORAGES)


def get_registered_compressors() -> set[str]:
    """Return the supported compression formats."""
    return {"zstd"}


def get_registered_serializers() -> set[str]:
    """Return an empty set, because no converters are needed for CDR, the only format."""
    return set()


def get_registered_writers() -> set[str]:
    """Return the storage formats that can be written."""
    return set(STORAGES)


def create_writer(options: StorageOptions, compression: str) -> BagWriter:
    """Create the writer of a recording from storage options.

    Raises:
        RuntimeError: there is no such storage, or the cache size for snapshots is not positive.
        LinkwrightError: see `BagWriter`.
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
