"""Rebuild the ``metadata.yaml`` of a recording, as ``ros2 bag reindex`` does."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from linkwright.bag.names import belong_together, find_storage_format, sort_by_number
from linkwright.bag.qos import to_text
from linkwright.bag.reading import BagReader
from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase
from linkwright.messages import type_hash


def reindex(folder: Path) -> None:
    """Write the ``metadata.yaml`` of a recording.

    An existing file is replaced. An unfinished file is listed with its complete messages.

    Args:
        folder: the folder with the files of one recording; their names end with _0, _1 and so on.

    Raises:
        LinkwrightError: BAG117, the folder has no such files; BAG105, the file cannot be written; see also `BagReader`.
    """
    from linkwright.bag.parts import write_metadata

    files = [path for path in folder.iterdir() if find_storage_format(path) is not None] if folder.is_dir() else []
    if len(files) != 1 and not belong_together(files):
        message = phrase("there are no files of a recording in '{path}'", path=display_path(folder))
        hint = phrase("pass a folder whose file names end with a number and .mcap or .db3, such as drive_0.mcap")
        raise LinkwrightError(Diagnostic("BAG117", message, hint=hint))
    file_metadata = []
    for file in sort_by_number(files):
        with BagReader(file) as bag:
            file_metadata.append(_make_file_metadata(bag, file))
    try:
        write_metadata(folder, file_metadata)
    except OSError as error:
        reason = foreign(error.strerror or str(error))
        message = phrase("recording '{path}' cannot be created: {reason}", path=display_path(folder), reason=reason)
        raise LinkwrightError(Diagnostic("BAG105", message)) from error


def _make_file_metadata(bag: BagReader, file: Path) -> dict[str, Any]:
    """Return the metadata of one file of a recording."""
    from linkwright.bag.parts import VERSION

    times = {
        "starting_time": {"nanoseconds_since_epoch": bag.start_ns},
        "duration": {"nanoseconds": bag.end_ns - bag.start_ns},
        "message_count": sum(topic.count for topic in bag.topics),
    }
    topics = [
        {
            "topic_metadata": {
                "name": topic.name,
                "type": topic.type_name,
                "serialization_format": topic.serialization_format,
                "offered_qos_profiles": to_text(topic.offered_qos),
                "type_description_hash": type_hash(topic.type_name),
            },
            "message_count": topic.count,
        }
        for topic in bag.topics
    ]
    return {
        "version": VERSION,
        "storage_identifier": bag.storage,
        "relative_file_paths": [file.name],
        **times,
        "topics_with_message_count": topics,
        "compression_format": "zstd" if bag.compression else "",
        "compression_mode": bag.compression,
        "files": [{"path": file.name, **times}],
        "custom_data": None,
        "ros_distro": "rosbags",
    }
