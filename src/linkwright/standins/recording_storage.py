"""The data classes of ``rosbag2_py``: options, filters and the metadata of recordings."""

from __future__ import annotations

import enum
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from linkwright.bag import STORAGES, BagTopic, layout
from linkwright.bag.names import METADATA
from linkwright.bag.qos import from_text, to_text
from linkwright.graph.qos.profile import QoSProfile
from linkwright.graph.time.values import ClockType, Duration, Time


@dataclass(slots=True)
class StorageOptions:
    """The location and the storage format of a recording, and how to split it into files."""

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


@dataclass(slots=True)
class ConverterOptions:
    """The serialization formats of messages; only CDR is supported."""

    input_serialization_format: str = ""
    output_serialization_format: str = ""


@dataclass(slots=True)
class StorageFilter:
    """A filter that selects topics by name and by regular expression, or all topics by default."""

    topics: list[str] = field(default_factory=list)
    topics_regex: str = ""
    topics_regex_to_exclude: str = ""
    regex: str = ""
    exclude_topics: list[str] = field(default_factory=list)
    services_events: list[str] = field(default_factory=list)
    exclude_service_events: list[str] = field(default_factory=list)
    regex_to_exclude: str = ""

    def admits(self, topic: str) -> bool:
        """Return whether the filter includes a topic."""
        named, pattern = [*self.topics, *self.services_events], self.regex or self.topics_regex
        wanted = not (named or pattern) or topic in named or bool(pattern and re.search(pattern, topic))
        left_out = self.regex_to_exclude or self.topics_regex_to_exclude
        if topic in self.exclude_topics or topic in self.exclude_service_events:
            return False
        return wanted and not (left_out and re.search(left_out, topic))


class ReadOrderSortBy(enum.Enum):
    """The keys by which messages can be sorted."""

    ReceivedTimestamp = 0
    PublishedTimestamp = 1
    File = 2


@dataclass(slots=True)
class ReadOrder:
    """The order in which messages are read."""

    sort_by: ReadOrderSortBy = ReadOrderSortBy.ReceivedTimestamp
    reverse: bool = False


@dataclass(slots=True)
class MessageDefinition:
    """The definition of a message type in a recording, including its nested types."""

    topic_type: str
    encoding: str
    encoded_message_definition: str
    type_hash: str


@dataclass
class TopicMetadata:
    """The metadata of a topic in a recording.

    Pass all arguments except the name by keyword: in Humble there is no ``id``, and the QoS profiles are one string
    instead of a list.
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
        """Return whether the metadata of two topics are equal."""
        return self == other


@dataclass(slots=True)
class TopicInformation:
    """A topic and the number of its messages."""

    topic_metadata: TopicMetadata
    message_count: int


def _at(stamp_ns: int) -> Time:
    return Time(nanoseconds=stamp_ns, clock_type=ClockType.SYSTEM_TIME)


@dataclass(slots=True)
class FileInformation:
    """A file of a recording."""

    path: str
    starting_time: Time
    duration: Duration
    message_count: int


@dataclass(repr=False, slots=True)
class BagMetadata:
    """The metadata of a recording."""

    version: int = 9
    bag_size: int = 0
    storage_identifier: str = ""
    relative_file_paths: list[str] = field(default_factory=list)
    files: list[FileInformation] = field(default_factory=list)
    duration: Duration = field(default_factory=Duration)
    starting_time: Time = field(default_factory=lambda: _at(0))
    message_count: int = 0
    topics_with_message_count: list[TopicInformation] = field(default_factory=list)
    compression_format: str = ""
    compression_mode: str = ""
    custom_data: dict[str, str] = field(default_factory=dict)
    ros_distro: str = ""

    def __repr__(self) -> str:
        """Return the metadata in the format of ``ros2 bag info``."""
        start = self.starting_time.nanoseconds
        topics = [
            BagTopic(
                topic_metadata.name, topic_metadata.type, counted.message_count, topic_metadata.serialization_format, ()
            )
            for counted in self.topics_with_message_count
            for topic_metadata in [counted.topic_metadata]
        ]
        end = start + self.duration.nanoseconds
        return layout(self.relative_file_paths, self.bag_size, self.storage_identifier, (start, end), topics)


class MetadataIo:
    """Reads and writes ``metadata.yaml`` in version 8, which Humble and later can read."""

    def metadata_file_exists(self, uri: str) -> bool:
        """Return whether a folder contains a ``metadata.yaml``."""
        return (Path(uri) / METADATA).exists()

    def read_metadata(self, uri: str) -> BagMetadata:
        """Read the ``metadata.yaml`` in a folder.

        Raises:
            RuntimeError: there is no such file, or its structure is invalid.
        """
        import yaml

        from linkwright.bag.parts import INFORMATION

        folder = Path(uri)
        try:
            found = _metadata(yaml.safe_load((folder / METADATA).read_text(encoding="utf-8"))[INFORMATION])
        except (OSError, ValueError, TypeError, KeyError, yaml.YAMLError) as error:
            raise RuntimeError(f"Exception on parsing info file: {error}") from error
        found.bag_size = sum(path.stat().st_size for path in folder.iterdir() if path.is_file())
        return found

    def write_metadata(self, uri: str, metadata: BagMetadata) -> None:
        """Write ``metadata.yaml`` into a folder."""
        from linkwright.bag.parts import write_information

        write_information(Path(uri), _information(metadata))

    def serialize_metadata(self, metadata: BagMetadata) -> str:
        """Return the contents of a ``metadata.yaml`` without the root key."""
        import yaml

        return yaml.safe_dump(_information(metadata), sort_keys=False, allow_unicode=True)

    def deserialize_metadata(self, serialized_metadata: str) -> BagMetadata:
        """Parse the output of `serialize_metadata`.

        Raises:
            RuntimeError: the structure of the YAML is invalid.
        """
        import yaml

        try:
            return _metadata(yaml.safe_load(serialized_metadata))
        except (ValueError, TypeError, KeyError, yaml.YAMLError) as error:
            raise RuntimeError(f"bad conversion: {error}") from error


def get_default_storage_id() -> str:
    """Return the name of the storage format that new recordings have by default."""
    return STORAGES[0]


def to_rclcpp_qos_vector(serialized: str, version: int) -> list[QoSProfile]:  # noqa: ARG001 - rosbag2's signature
    """Parse the QoS profiles of a topic in a ``metadata.yaml`` of any version."""
    return from_text(serialized)


def convert_rclcpp_qos_to_rclpy_qos(qos_input: QoSProfile) -> QoSProfile:
    """Return the profile unchanged, because the profiles of recordings are already rclpy profiles."""
    return qos_input


def _metadata(found: Mapping[str, Any]) -> BagMetadata:
    """Return the metadata for a parsed ``metadata.yaml``, with defaults for keys that old versions lack."""
    topics = []
    for entry in found["topics_with_message_count"]:
        known = dict(entry["topic_metadata"])
        known["offered_qos_profiles"] = from_text(known.get("offered_qos_profiles", ""))
        topics.append(TopicInformation(TopicMetadata(**known), entry["message_count"]))
    files = [
        FileInformation(entry["path"], *_span(entry), entry["message_count"]) for entry in found.get("files") or ()
    ]
    starting_time, duration = _span(found)
    return BagMetadata(
        version=found["version"],
        storage_identifier=found["storage_identifier"],
        relative_file_paths=list(found["relative_file_paths"]),
        files=files,
        duration=duration,
        starting_time=starting_time,
        message_count=found["message_count"],
        topics_with_message_count=topics,
        compression_format=found.get("compression_format") or "",
        compression_mode=found.get("compression_mode") or "",
        custom_data=dict(found.get("custom_data") or {}),
        ros_distro=found.get("ros_distro") or "",
    )


def _span(found: Mapping[str, Any]) -> tuple[Time, Duration]:
    start, duration = found["starting_time"]["nanoseconds_since_epoch"], found["duration"]["nanoseconds"]
    return _at(start), Duration(nanoseconds=duration)


def _information(metadata: BagMetadata) -> dict[str, Any]:
    from linkwright.bag.parts import VERSION

    def span(what: BagMetadata | FileInformation) -> dict[str, Any]:
        return {
            "starting_time": {"nanoseconds_since_epoch": what.starting_time.nanoseconds},
            "duration": {"nanoseconds": what.duration.nanoseconds},
            "message_count": what.message_count,
        }

    topics = []
    for topic_information in metadata.topics_with_message_count:
        known = asdict(topic_information.topic_metadata)
        del known["id"]
        profiles = topic_information.topic_metadata.offered_qos_profiles
        known["offered_qos_profiles"] = profiles if isinstance(profiles, str) else to_text(profiles)
        topics.append({"topic_metadata": known, "message_count": topic_information.message_count})
    return {
        "version": VERSION,
        "storage_identifier": metadata.storage_identifier,
        "relative_file_paths": list(metadata.relative_file_paths),
        **span(metadata),
        "topics_with_message_count": topics,
        "compression_format": metadata.compression_format,
        "compression_mode": metadata.compression_mode,
        "files": [{"path": file.path, **span(file)} for file in metadata.files],
        "custom_data": dict(metadata.custom_data) or None,
        "ros_distro": metadata.ros_distro,
    }
