"""The export of a robot as a file."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import PageMessage, ServerMessage
from linkwright.page.protocol.views_and_tools import View


class AskExport(PageMessage):
    """The user exports the scene as a file; `view` is the page's camera."""

    format: Literal["html", "glb"]
    view: View


class ExportReady(ServerMessage):
    """The file can be fetched once, from an address of the server; answers `AskExport`.

    `outside` are the paths of included files that are neither in a package nor below the description's folder.
    """

    url: str
    name: str
    outside: list[str]


class ExportFailed(ServerMessage):
    """The file could not be made; answers `AskExport`."""

    message: str
