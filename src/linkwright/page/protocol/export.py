"""The export of a robot as a file."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import PageMessage, ServerMessage
from linkwright.page.protocol.views_and_tools import View


class RequestExport(PageMessage):
    """A request to export the scene as a file. `view` is the current view of the page."""

    format: Literal["html", "glb"]
    view: View


class ExportReady(ServerMessage):
    """The address of the exported file, for one download. Response to `RequestExport`.

    `outside_files` lists the paths of included files that are neither in a package nor below the description's folder.
    """

    url: str
    name: str
    outside_files: list[str]


class ExportFailed(ServerMessage):
    """The reason why an export failed. Response to `RequestExport`."""

    message: str
