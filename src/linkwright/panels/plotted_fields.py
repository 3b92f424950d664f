"""Fields to plot in the notation of ``rqt_plot``: ``/odom/twist/twist/linear/x:y``."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from linkwright.messages import Message
from linkwright.panels.monitor.field_paths import FieldPath, FieldPathError, find_plot_fields


def split_fields(text: str) -> list[str]:
    """Return the fields of an argument of ``rqt_plot``.

    Names after a colon replace the last name: ``/pose/x:y`` means ``/pose/x`` and ``/pose/y``.
    """
    first, *others = text.split(":")
    parent = first.rpartition("/")[0]
    return [first, *(f"{parent}/{other}" for other in others if other)]


def split_topic(field: str, topics: Collection[str]) -> tuple[str, str] | None:
    """Return the topic and the path in its messages, or None if no topic contains the field.

    Args:
        field: a field such as ``/odom/twist/twist/linear/x``; in the path, dots are accepted as separators, too.
        topics: the names of the existing topics.
    """
    head, dot, tail = field.partition(".")
    parts = head.split("/")
    for count in range(len(parts), 1, -1):
        topic = "/".join(parts[:count])
        if topic in topics:
            return topic, ".".join([*parts[count:], *([tail] if dot else [])])
    return None


def find_numeric_fields(path: str, message_class: type[Message]) -> Iterator[str]:
    """Yield the paths to plot for a path in messages of a class.

    They are the path itself, or, as in ``rqt_plot``, the numbers directly in the message to which it leads. An invalid
    path is yielded unchanged, so that the plot shows the reason.
    """
    prefix = f"{path}." if path else ""
    if path:
        try:
            FieldPath(path).check(message_class)
        except FieldPathError:
            pass
        else:
            yield path
            return
    children = [
        field.path
        for field in find_plot_fields(message_class)
        if field.path.startswith(prefix) and "." not in field.path[len(prefix) :]
    ]
    yield from children or ([path] if path else [])
