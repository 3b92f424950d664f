"""Replacement of the running world by another file or text, for ``/load_world``.

The service has the type ``simulation_interfaces/srv/LoadWorld``, but differs from it in two points. By definition, the
scene is cleared and the simulation stops; here, the common parts of both worlds, spawned models and the time continue.
By definition, ``resource_string`` is ignored if there is a ``uri``; here, it is the edited text of this file, which
need not be saved. ``uri`` is the path or address of a file, or the name of a world.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, phrase
from linkwright.messages import get_message
from linkwright.simulation.plugins.entities import format_finding
from linkwright.simulation.server.server import SimulationServer
from linkwright.simulation.server.worlds import LoadedWorld, load_world
from linkwright.xmltree.decoding import decode_with_encoding
from linkwright.xmltree.reader import read_bytes

_OK, _NOT_FOUND, _FAILED = 1, 2, 4
"""Result codes of simulation_interfaces/msg/Result."""
_UNSUPPORTED_FORMAT, _NO_RESOURCE, _UNREADABLE, _MISSING_ASSETS, _UNSUPPORTED_ELEMENTS = 101, 102, 103, 104, 106
"""Result codes of simulation_interfaces/srv/LoadWorld."""
_RESULTS_BY_CODE = {
    "SIM150": _NOT_FOUND,
    "SIM151": _UNSUPPORTED_FORMAT,
    "SIM102": _FAILED,
    "SIM104": _FAILED,
    "SIM105": _FAILED,
    "SIM106": _FAILED,
    "SIM140": _FAILED,
    "SIM152": _NO_RESOURCE,
}
_MISSING_CODES, _UNREAD_CODES = ("SDF160", "SIM112"), ("SDF150",)
"""The codes of findings on missing models and meshes, and on elements that are not read."""
_TEXT_NAME = "<the world>"


class WorldLoader:
    """A loader that replaces the world of a running simulation.

    Args:
        server: the server of the simulation.
        loaded: the initial world.

    Attributes:
        loaded: the running world.
    """

    def __init__(self, server: SimulationServer, loaded: LoadedWorld) -> None:
        self.loaded = loaded
        self._server = server
        self._text: str | None = None

    @property
    def is_unsaved(self) -> bool:
        """Whether the running world was loaded from a text that differs from the world's file."""
        if self._text is None:
            return False
        path = self.loaded.path
        try:
            return decode_with_encoding(read_bytes(path), str(path)).text != self._text
        except LinkwrightError:
            return True

    def load(self, uri: str, text: str = "", *, blocking_codes: Sequence[str] = ()) -> None:
        """Replace the running world with the world in a file or text.

        Findings that the running world also has do not prevent the replacement.

        Args:
            uri: the path or address of a file, or the name of a world; empty for a text without a file.
            text: the text of the world, which is used instead of the text of the file; empty to read the file.
            blocking_codes: the codes of warnings that, like errors, prevent the replacement.

        Raises:
            LinkwrightError: the world cannot be read or simulated; nothing has changed.
        """
        if not (uri or text):
            hint = phrase("pass the path of a world file, or the text of a world")
            raise LinkwrightError(Diagnostic("SIM152", phrase("no world was specified"), hint=hint))
        loaded = load_world(uri or str(Path.cwd() / _TEXT_NAME), text or None)
        running_findings = {
            _get_finding_key(diagnostic)
            for diagnostic in (*self.loaded.diagnostics, *self._server.simulation.scene.diagnostics)
        }

        def check_findings(findings: Sequence[Diagnostic]) -> None:
            new_errors = [
                finding
                for finding in findings
                if (finding.severity is Severity.ERROR or finding.code in blocking_codes)
                and _get_finding_key(finding) not in running_findings
            ]
            if new_errors:
                raise LinkwrightError(*new_errors)

        check_findings(loaded.diagnostics)
        self._server.load(loaded.world, loaded.finder, check_findings)
        self.loaded = loaded
        self._text = text or None

    def handle_request(self, request: Any, response: Any) -> Any:
        """Handle a request to the ``/load_world`` service."""
        resource = request.world_resource
        blocking_codes = (
            *(() if request.ignore_missing_or_unsupported_assets else _MISSING_CODES),
            *(_UNREAD_CODES if request.fail_on_unsupported_element else ()),
        )
        try:
            self.load(resource.uri, resource.resource_string, blocking_codes=blocking_codes)
        except LinkwrightError as error:
            finding = error.diagnostics[0]
            response.result.result = _to_result_code(finding)
            response.result.error_message = format_finding(finding)
            return response
        response.result.result = _OK
        response.world.name = self.loaded.world.name
        response.world.world_resource = get_message("simulation_interfaces/msg/Resource")(uri=str(self.loaded.path))
        return response


def _to_result_code(finding: Diagnostic) -> int:
    if finding.code in _MISSING_CODES:
        return _MISSING_ASSETS
    if finding.code in _UNREAD_CODES:
        return _UNSUPPORTED_ELEMENTS
    return _RESULTS_BY_CODE.get(finding.code, _UNREADABLE)


def _get_finding_key(finding: Diagnostic) -> tuple[str, str]:
    return finding.code, str(finding.message)
