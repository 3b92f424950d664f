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
    """The file can be fetched, once, from an address of the server; answers `AskExport`.

    `outside` are the paths of files in no package, nor below the folder of the description, whose contents are in it.
    """

    url: str
    name: str
    outside: list[str]


class ExportFailed(ServerMessage):
    """The file could not be made; answers `AskExport`."""

    message: str
