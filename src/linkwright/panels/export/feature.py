"""Exports the robot to one of several file formats, as one download."""

from __future__ import annotations

import asyncio
import re
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from linkwright.diagnostics import LinkwrightError, display_path, join_messages
from linkwright.page.audience import Page
from linkwright.page.files import Download
from linkwright.page.protocol.export import ExportFailed, ExportReady, RequestExport
from linkwright.panels.export.snapshot import Snapshot, take_configuration_snapshot
from linkwright.panels.page_feature import FeatureHost, PageFeature


@dataclass(frozen=True, slots=True)
class Format:
    """A file format.

    Attributes:
        content_type: the MIME type.
        write: returns the content of the file for a snapshot.
    """

    content_type: str
    write: Callable[[Snapshot], bytes]


def _write_html(snapshot: Snapshot) -> bytes:
    from linkwright.panels.export.html import write_html

    return write_html(snapshot)


def _write_glb(snapshot: Snapshot) -> bytes:
    from linkwright.panels.export.gltf import write_glb

    return write_glb(snapshot)


FORMATS = {
    "html": Format("text/html; charset=utf-8", _write_html),
    "glb": Format("model/gltf-binary", _write_glb),
}
"""The formats by the extension of the file."""


def find_format(name: str) -> Format | None:
    """Return the format for the extension of a file name, or None if it is not supported."""
    return FORMATS.get(name.rpartition(".")[2].lower()) if "." in name else None


def export_snapshot(snapshot: Snapshot, extension: str) -> bytes:
    """Return the content of the exported file.

    Raises:
        LinkwrightError: the file cannot be created.
    """
    return FORMATS[extension].write(snapshot)


class ExportFeature(PageFeature):
    """The feature that exports the robot of a page's configuration."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._export_tasks: dict[Page, asyncio.Task[None]] = {}

    def receive(self, page: Page, message: RequestExport) -> None:
        """Start an export, unless an export of the page is already running."""
        if message.format not in FORMATS or page in self._export_tasks:
            return
        task = asyncio.get_running_loop().create_task(self._export(page, message))
        self._export_tasks[page] = task
        task.add_done_callback(lambda _: self._export_tasks.pop(page, None))

    def close(self) -> None:
        """Cancel running exports."""
        for task in self._export_tasks.values():
            task.cancel()

    async def _export(self, page: Page, message: RequestExport) -> None:
        try:
            snapshot = take_configuration_snapshot(self.viewer, self.managers.of(page), message.view)
            data = await asyncio.to_thread(partial(export_snapshot, snapshot, message.format))
        except LinkwrightError as error:
            page.send(ExportFailed(join_messages(error.diagnostics)))
            return
        except Exception as error:  # noqa: BLE001  # an internal error must not leave the page waiting
            self.context.node.get_logger().error(
                f"The export failed:\n{traceback.format_exc()}"
            )  # The logger is rclpy's, which has no method `exception`.
            page.send(ExportFailed(f"{type(error).__name__}: {error}"))
            return
        name = re.sub(r"[^\w.-]+", "_", snapshot.name).strip("._") or "robot"
        file = Download(f"{name}.{message.format}", FORMATS[message.format].content_type, data)
        outside_paths = [display_path(path) for path in snapshot.outside_files]
        page.send(ExportReady(self.context.downloads.offer_once(file), file.name, outside_paths))
