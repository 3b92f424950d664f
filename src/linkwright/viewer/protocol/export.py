"""The robot as a file."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.message import PageMessage, ServerMessage
from linkwright.viewer.protocol.views_and_tools import View


class AskExport(PageMessage):
    """The user wants what is seen as a file; `view` is the camera as the page has it."""

    format: Literal["html", "glb"]
    view: View


class ExportReady(ServerMessage):
    """The file can be fetched, once, from an address of the server; answers `AskExport`."""

    url: str
    name: str


class ExportFailed(ServerMessage):
    """The file could not be made; answers `AskExport`."""

    message: str
