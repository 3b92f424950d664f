"""The summary of a recording that ``bag info`` prints."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime

from linkwright.bag.reading import BagReader, BagTopic
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND


def summarize_bag(bag: BagReader, *, topic_names_only: bool = False) -> str:
    """Return the summary of a recording in the format of ``ros2 bag info``.

    The summary contains files, times and topics.

    Args:
        bag: the recording.
        topic_names_only: whether to list only the names of topics, one per line.
    """
    if topic_names_only:
        return "".join(f"{topic.name}\n" for topic in bag.topics)
    size = sum(file.stat().st_size for file in bag.files)
    return format_summary([file.name for file in bag.files], size, bag.storage, (bag.start_ns, bag.end_ns), bag.topics)


def format_summary(
    files: Sequence[str], size: int, storage: str, span_ns: tuple[int, int], topics: Sequence[BagTopic]
) -> str:
    """Return a recording's summary as text.

    Args:
        files: the names of the files.
        size: the total size of the files, in bytes.
        storage: one of `linkwright.bag.STORAGES`.
        span_ns: the times of the first and the last message, in nanoseconds since the epoch.
        topics: the topics with their types and message counts.
    """
    start, end = span_ns
    lines = [
        f"Topic: {topic.name} | Type: {topic.type_name} | Count: {topic.count} | "
        f"Serialization Format: {topic.serialization_format}"
        for topic in topics
    ]
    rows = [
        ("Files:", "\n".join(files)),
        ("Bag size:", _format_size(size)),
        ("Storage id:", storage),
        ("Duration:", f"{_format_duration(end - start)}s"),
        ("Start:", _format_time(start)),
        ("End:", _format_time(end)),
        ("Messages:", str(sum(topic.count for topic in topics))),
        ("Topic information:", "\n".join(lines)),
    ]
    indent = " " * 19
    return "\n" + "".join(f"{name:19}{text.replace(chr(10), chr(10) + indent)}".rstrip() + "\n" for name, text in rows)


def _format_time(stamp_ns: int) -> str:
    seconds, nanoseconds = divmod(stamp_ns, NANOSECONDS_PER_SECOND)
    local_time = datetime.fromtimestamp(seconds).astimezone()
    return (
        f"{local_time:%b} {local_time.day:2} {local_time:%Y %H:%M:%S}.{nanoseconds:09d} ({seconds}.{nanoseconds:09d})"
    )


def _format_duration(duration_ns: int) -> str:
    seconds, nanoseconds = divmod(duration_ns, NANOSECONDS_PER_SECOND)
    return f"{seconds}.{nanoseconds:09d}"


def _format_size(size: float) -> str:
    for unit in ("B", "KiB", "MiB", "GiB"):
        if size < 1024 or unit == "GiB":
            return f"{size:.0f} B" if unit == "B" else f"{size:.1f} {unit}"
        size /= 1024
    raise AssertionError
