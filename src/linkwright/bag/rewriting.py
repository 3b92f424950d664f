"""Rewrite recordings with other topics or compression, as ``ros2 bag convert`` does.

The keys of the options file, in YAML, are those of rosbag2's ``StorageOptions`` and ``RecordOptions``. Keys that
only affect rosbag2's performance are ignored.
"""

from __future__ import annotations

import heapq
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from linkwright.bag.reading import BagReader
from linkwright.bag.selection import TopicSelection
from linkwright.bag.writing import COMPRESSIONS, STORAGES, BagWriter
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, phrase, quoted_names
from linkwright.graph import QoSProfile

_LIST_KEYS = ("topics", "topic_types", "services", "exclude_topics", "exclude_topic_types", "exclude_services")


def rewrite(sources: Sequence[str | Path], options_file: str | Path) -> list[Path]:
    """Write new recordings with the messages of other recordings, ordered by time.

    Args:
        sources: the recordings to read.
        options_file: a YAML file; its key ``output_bags`` is a list with the options of each new recording.

    Returns:
        The paths of the new recordings.

    Raises:
        LinkwrightError: BAG115, the options cannot be read; see also `BagReader` and `BagWriter`.
    """
    outputs = [_Output(entry, str(options_file)) for entry in _read_entries(options_file)]
    with ExitStack() as stack:
        bags = [stack.enter_context(BagReader(source)) for source in sources]
        writers = [stack.enter_context(output.open_writer(bags)) for output in outputs]
        streams = [bag.messages() for bag in bags]
        for topic, stamp_ns, data in heapq.merge(*streams, key=lambda message: message[1]):
            for output, writer in zip(outputs, writers, strict=True):
                if topic in writer.topics and output.begin_ns <= stamp_ns <= output.end_ns:
                    writer.write(topic, stamp_ns, data)
    return [writer.path for writer in writers]


class _Output:
    """A new recording, from an entry in the options file.

    Attributes:
        begin_ns, end_ns: the first and last time of messages to write, in nanoseconds since the epoch.
    """

    def __init__(self, entry: Mapping[str, Any], file: str) -> None:
        self._entry = entry
        self._file = file
        for name in _LIST_KEYS:
            value = entry.get(name, [])
            if not (isinstance(value, list) and all(isinstance(item, str) for item in value)):
                raise self._options_error(phrase("'{name}' must be a list of names", name=name))
        self._storage = self._read_choice("storage_id", STORAGES)
        compression = str(entry.get("compression_mode") or "none").lower()
        self._compression = self._check_choice("compression_mode", compression, COMPRESSIONS)
        self._max_size = self._read_number("max_bagfile_size", 0)
        self._max_seconds = self._read_number("max_bagfile_duration", 0)
        start_ns, end_ns = self._read_number("start_time_ns", -1), self._read_number("end_time_ns", -1)
        self.begin_ns = max(start_ns, 0)
        self.end_ns = end_ns if end_ns >= 0 else 2**63 - 1
        record_all = bool(entry.get("all"))
        self._selection = TopicSelection(
            all_topics=record_all or bool(entry.get("all_topics")),
            names=entry.get("topics", []),
            types=entry.get("topic_types", []),
            pattern=str(entry.get("regex", "")),
            without_names=entry.get("exclude_topics", []),
            without_types=entry.get("exclude_topic_types", []),
            without_pattern=str(entry.get("exclude_regex", entry.get("exclude", ""))),
            include_hidden=bool(entry.get("include_hidden_topics")),
            all_services=record_all or bool(entry.get("all_services")),
            services=entry.get("services", []),
            without_services=entry.get("exclude_services", []),
        )

    def open_writer(self, bags: Sequence[BagReader]) -> BagWriter:
        """Create the recording with its topics, and return its writer.

        A topic with different types in the source recordings is left out, as in rosbag2.
        """
        writer = BagWriter(
            str(self._entry["uri"]),
            self._storage,
            compression=self._compression,
            max_size=self._max_size,
            max_seconds=self._max_seconds,
            custom_data={str(key): str(value) for key, value in (self._entry.get("custom_data") or {}).items()},
        )
        types: dict[str, set[str]] = {}
        profiles: dict[str, list[QoSProfile]] = {}
        for topic in (topic for bag in bags for topic in bag.topics):
            types.setdefault(topic.name, set()).add(topic.type_name)
            profiles.setdefault(topic.name, []).extend(topic.offered_qos)
        for name, type_names in types.items():
            (type_name, *other_types) = type_names
            if not other_types and self._selection.selects(name, type_name):
                writer.add_topic(name, type_name, profiles[name])
        return writer

    def _read_number(self, name: str, default: int) -> int:
        value = self._entry.get(name, default)
        if type(value) is not int:
            raise self._options_error(phrase("'{name}' must be an integer", name=name))
        return value

    def _read_choice(self, name: str, choices: Sequence[str]) -> str:
        return self._check_choice(name, str(self._entry.get(name) or choices[0]), choices)

    def _check_choice(self, name: str, value: str, choices: Sequence[str]) -> str:
        if value not in choices:
            names = quoted_names(choices, " or ")
            raise self._options_error(
                phrase("'{name}' must be {names}, not '{value}'", name=name, names=names, value=value)
            )
        return value

    def _options_error(self, reason: Phrase) -> LinkwrightError:
        return _unusable_options_error(self._file, reason)


def _read_entries(path: str | Path) -> list[Mapping[str, Any]]:
    import yaml

    from linkwright.files.input_files import read_text

    try:
        document = yaml.safe_load(read_text(path))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise _unusable_options_error(str(path), foreign(reason or str(error))) from error
    entries = document.get("output_bags") if isinstance(document, dict) else None
    if not isinstance(entries, list) or not entries:
        raise _unusable_options_error(
            str(path), phrase("the file must have the key 'output_bags' with a list of the recordings to write")
        )
    for entry in entries:
        if not isinstance(entry, dict) or not isinstance(entry.get("uri"), str):
            raise _unusable_options_error(
                str(path), phrase("each entry of 'output_bags' must have the key 'uri' with the folder to create")
            )
    return entries


def _unusable_options_error(path: str, reason: Phrase) -> LinkwrightError:
    message = phrase("the recording options in '{path}' cannot be used: {reason}", path=path, reason=reason)
    return LinkwrightError(Diagnostic("BAG115", message))
