"""The robot as a file."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.record import record
from linkwright.viewer.protocol.views import View


@record
class AskExport:
    """The user wants what is seen as a file; `view` is the camera as the page has it."""

    format: Literal["html", "glb"]
    view: View
    type: Literal["ask_export"] = "ask_export"


@record
class ExportReady:
    """The file can be fetched, once, from an address of the server; answers `AskExport`."""

    url: str
    name: str
    type: Literal["export_ready"] = "export_ready"


@record
class ExportFailed:
    """The file could not be made; answers `AskExport`."""

    message: str
    type: Literal["export_failed"] = "export_failed"
