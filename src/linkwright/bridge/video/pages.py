"""The pages of the server: the list of topics, and the page that shows a stream."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from urllib.parse import quote


def write_list(cameras: Mapping[str, Sequence[str]]) -> str:
    """Return the page with the topics that have images.

    Args:
        cameras: the topics by the names of their cameras, see `find_image_topics`.
    """
    body = ""
    for base, topics in cameras.items():
        lines = _list_lines(_write_links(topic, topic.removeprefix(base)) for topic in topics)
        body += _list_lines([f"{escape(base)}{lines}"]) if base else lines
    body = body or "<p>No topic has images yet: reload this page once a camera publishes.</p>"
    return _write_page("ROS Image Topic List", "Available ROS Image Topics:", body)


def write_viewer(topic: str, query: str) -> str:
    """Return the page that shows a stream.

    Args:
        topic: the topic of the stream.
        query: the query of the request, which the stream has as well.
    """
    return _write_page(topic, topic, f'<img src="/stream?{escape(query)}" alt="{escape(topic)}">')


def _write_links(topic: str, name: str) -> str:
    def link(path: str, text: str) -> str:
        return f'<a href="/{path}?topic={escape(quote(topic))}">{escape(text)}</a>'

    return f"{link('stream_viewer', name)} ({link('stream', 'Stream')}) ({link('snapshot', 'Snapshot')})"


def _list_lines(items: Iterable[str]) -> str:
    return f"<ul>{''.join(f'<li>{item}</li>' for item in items)}</ul>"


def _write_page(title: str, heading: str, body: str) -> str:
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title></head>'
        f"<body><h1>{escape(heading)}</h1>{body}</body></html>\n"
    )
