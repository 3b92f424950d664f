"""What a robot can be exported to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from linkwright.viewer.features.export.snapshot import Snapshot


@dataclass(frozen=True, slots=True)
class Format:
    """A kind of file.

    Attributes:
        content_type: its MIME type.
        write: makes it.
    """

    content_type: str
    write: Callable[[Snapshot], bytes]


def _html(snapshot: Snapshot) -> bytes:
    from linkwright.viewer.features.export.html import html_of

    return html_of(snapshot)


def _glb(snapshot: Snapshot) -> bytes:
    from linkwright.viewer.features.export.robot_gltf import glb_of

    return glb_of(snapshot)


FORMATS = {
    "html": Format("text/html; charset=utf-8", _html),
    "glb": Format("model/gltf-binary", _glb),
}
"""By the ending of the file."""


def format_of(name: str) -> Format | None:
    """The format that the ending of a file's name says."""
    return FORMATS.get(name.rpartition(".")[2].lower()) if "." in name else None


def export_snapshot(snapshot: Snapshot, ending: str) -> bytes:
    """The file.

    Raises:
        LinkwrightError: it cannot be made; the diagnostic says why.
    """
    return FORMATS[ending].write(snapshot)
