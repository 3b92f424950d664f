"""The data classes of ``rosbag2_py``: options, filters and the metadata of recordings."""

from __future__ import annotations

import enum
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from linkwright.bag import STORAGES, BagTopic, format_summary
from linkwright.bag.names import METADATA_FILE
from linkwright.bag.qos import from_text, to_text
from linkwright.graph.qos.profile import QoSProfile
from linkwright.graph.time.values import ClockType, Duration, Time


@dataclass(slots=True)
class StorageOptions:
    """The location and format of a recording, and the limits at which it is split into files.

    Sizes are in bytes, durations in seconds, and times in nanoseconds since the epoch.
    """

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
    """The serialization formats of messages.

    Only CDR is supported.
    """

    input_serialization_format: str = ""
    output_serialization_format: str = ""


@dataclass(slots=True)
class StorageFilter:
    """A filter that selects topics by name and by regular expression.

    By default, the filter selects all topics.
    """

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
        selected_names, pattern = [*self.topics, *self.services_events], self.regex or self.topics_regex
        is_selected = (
            not (selected_names or pattern) or topic in selected_names or bool(pattern and re.search(pattern, topic))
        )
        exclude_pattern = self.regex_to_exclude or self.topics_regex_to_exclude
        if topic in self.exclude_topics or topic in self.exclude_service_events:
            return False
        return is_selected and not (exclude_pattern and re.search(exclude_pattern, topic))


class ReadOrderSortBy(enum.Enum):
    """The keys by which messages can be sorted."""

    ReceivedTimestamp = 0
    PublishedTimestamp = 1
    File = 2


@dataclass(slots=True)
class ReadOrder:
    """The order of reading messages."""

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

    Programs should pass all arguments except the name by keyword: Humble has no ``id``, and a string instead of a list
    of QoS profiles.
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
        arguments = dict(zip(names, args, strict=False)) | kwargs
        unexpected_names = arguments.keys() - {"id", *names}
        if unexpected_names or len(args) > len(names):
            raise TypeError(f"TopicMetadata() got unexpected arguments: {', '.join(sorted(unexpected_names)) or args}")
        for name, value in arguments.items():
            setattr(self, name, value)

    def equals(self, other: TopicMetadata) -> bool:
        """Return whether this metadata equals another topic's."""
        return self == other


@dataclass(slots=True)
class TopicInformation:
    """A topic and the number of its messages."""

    topic_metadata: TopicMetadata
    message_count: int


def _to_time(stamp_ns: int) -> Time:
    return Time(nanoseconds=stamp_ns, clock_type=ClockType.SYSTEM_TIME)


@dataclass(slots=True)
class FileInformation:
    """The time range and the number of messages of one file of a recording."""

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
    starting_time: Time = field(default_factory=lambda: _to_time(0))
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
                topic_metadata.name,
                topic_metadata.type,
                information.message_count,
                topic_metadata.serialization_format,
                (),
            )
            for information in self.topics_with_message_count
            for topic_metadata in [information.topic_metadata]
        ]
        end = start + self.duration.nanoseconds
        return format_summary(self.relative_file_paths, self.bag_size, self.storage_identifier, (start, end), topics)


class MetadataIo:
    """A reader and writer of ``metadata.yaml`` files.

    The files are written in version 8, for Humble and later.
    """

    def metadata_file_exists(self, uri: str) -> bool:
        """Return whether a folder contains a ``metadata.yaml``."""
        return (Path(uri) / METADATA_FILE).exists()

    def read_metadata(self, uri: str) -> BagMetadata:
        """Read the ``metadata.yaml`` in a folder.

        Raises:
            RuntimeError: there is no such file, or its structure is invalid.
        """
        import yaml

        from linkwright.bag.parts import INFORMATION_KEY

        folder = Path(uri)
        try:
            metadata = _parse_metadata(
                yaml.safe_load((folder / METADATA_FILE).read_text(encoding="utf-8"))[INFORMATION_KEY]
            )
        except (OSError, ValueError, TypeError, KeyError, yaml.YAMLError) as error:
            raise RuntimeError(f"Exception on parsing info file: {error}") from error
        metadata.bag_size = sum(path.stat().st_size for path in folder.iterdir() if path.is_file())
        return metadata

    def write_metadata(self, uri: str, metadata: BagMetadata) -> None:
        """Write ``metadata.yaml`` into a folder."""
        from linkwright.bag.parts import write_information

        write_information(Path(uri), _convert_metadata(metadata))

    def serialize_metadata(self, metadata: BagMetadata) -> str:
        """Return the contents of a ``metadata.yaml`` without the root key."""
        import yaml

        return yaml.safe_dump(_convert_metadata(metadata), sort_keys=False, allow_unicode=True)

    def deserialize_metadata(self, serialized_metadata: str) -> BagMetadata:
        """Parse the output of `serialize_metadata`.

        Raises:
            RuntimeError: the structure of the YAML is invalid.
        """
        import yaml

        try:
            return _parse_metadata(yaml.safe_load(serialized_metadata))
        except (ValueError, TypeError, KeyError, yaml.YAMLError) as error:
            raise RuntimeError(f"bad conversion: {error}") from error


def get_default_storage_id() -> str:
    """Return the default storage format of new recordings."""
    return STORAGES[0]


def to_rclcpp_qos_vector(serialized: str, version: int) -> list[QoSProfile]:  # noqa: ARG001 - rosbag2's signature
    """Parse the QoS profiles of a topic in a ``metadata.yaml`` of any version."""
    return from_text(serialized)


def convert_rclcpp_qos_to_rclpy_qos(qos_input: QoSProfile) -> QoSProfile:
    """Return the profile unchanged, because recordings already have rclpy profiles."""
    return qos_input


def _parse_metadata(content: Mapping[str, Any]) -> BagMetadata:
    """Return the metadata from a parsed ``metadata.yaml``.

    Keys that older versions lack have default values.
    """
    topics = []
    for entry in content["topics_with_message_count"]:
        arguments = dict(entry["topic_metadata"])
        arguments["offered_qos_profiles"] = from_text(arguments.get("offered_qos_profiles", ""))
        topics.append(TopicInformation(TopicMetadata(**arguments), entry["message_count"]))
    files = [
        FileInformation(entry["path"], *_parse_time_range(entry), entry["message_count"])
        for entry in content.get("files") or ()
    ]
    starting_time, duration = _parse_time_range(content)
    return BagMetadata(
        version=content["version"],
        storage_identifier=content["storage_identifier"],
        relative_file_paths=list(content["relative_file_paths"]),
        files=files,
        duration=duration,
        starting_time=starting_time,
        message_count=content["message_count"],
        topics_with_message_count=topics,
        compression_format=content.get("compression_format") or "",
        compression_mode=content.get("compression_mode") or "",
        custom_data=dict(content.get("custom_data") or {}),
        ros_distro=content.get("ros_distro") or "",
    )


def _parse_time_range(entry: Mapping[str, Any]) -> tuple[Time, Duration]:
    start, duration = entry["starting_time"]["nanoseconds_since_epoch"], entry["duration"]["nanoseconds"]
    return _to_time(start), Duration(nanoseconds=duration)


def _convert_metadata(metadata: BagMetadata) -> dict[str, Any]:
    from linkwright.bag.parts import VERSION

    def convert_time_range(information: BagMetadata | FileInformation) -> dict[str, Any]:
        return {
            "starting_time": {"nanoseconds_since_epoch": information.starting_time.nanoseconds},
            "duration": {"nanoseconds": information.duration.nanoseconds},
            "message_count": information.message_count,
        }

    topics = []
    for topic_information in metadata.topics_with_message_count:
        topic_entry = asdict(topic_information.topic_metadata)
        del topic_entry["id"]
        profiles = topic_information.topic_metadata.offered_qos_profiles
        topic_entry["offered_qos_profiles"] = profiles if isinstance(profiles, str) else to_text(profiles)
        topics.append({"topic_metadata": topic_entry, "message_count": topic_information.message_count})
    return {
        "version": VERSION,
        "storage_identifier": metadata.storage_identifier,
        "relative_file_paths": list(metadata.relative_file_paths),
        **convert_time_range(metadata),
        "topics_with_message_count": topics,
        "compression_format": metadata.compression_format,
        "compression_mode": metadata.compression_mode,
        "files": [{"path": file.path, **convert_time_range(file)} for file in metadata.files],
        "custom_data": dict(metadata.custom_data) or None,
        "ros_distro": metadata.ros_distro,
    }
