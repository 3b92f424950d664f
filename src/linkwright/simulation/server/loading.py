"""Replaces the running world by the world in another file or text, for ``/load_world``.

Source: ``simulation_interfaces/srv/LoadWorld``. There, the scene is cleared and the simulation stops; here, the common
parts of both worlds, spawned models and the time continue. ``uri`` is the path or address of a file, or the name of a
world. The original ignores ``resource_string`` if there is a ``uri``; here, it is the edited text of the file, which
need not be saved.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, phrase
from linkwright.messages import get_message
from linkwright.simulation.plugins.entities import in_one_line
from linkwright.simulation.server.server import SimulationServer
from linkwright.simulation.server.worlds import LoadedWorld, load_world
from linkwright.xmltree.decoding import decoded
from linkwright.xmltree.reader import read_bytes

_OK, _NOT_FOUND, _FAILED = 1, 2, 4
"""Results of simulation_interfaces/msg/Result."""
_UNSUPPORTED_FORMAT, _NO_RESOURCE, _UNREADABLE, _MISSING_ASSETS, _UNSUPPORTED_ELEMENTS = 101, 102, 103, 104, 106
"""Results of simulation_interfaces/srv/LoadWorld."""
_RESULTS = {
    "SIM150": _NOT_FOUND,
    "SIM151": _UNSUPPORTED_FORMAT,
    "SIM102": _FAILED,
    "SIM104": _FAILED,
    "SIM105": _FAILED,
    "SIM106": _FAILED,
    "SIM140": _FAILED,
    "SIM152": _NO_RESOURCE,
}
_MISSING, _NOT_READ = ("SDF160", "SIM112"), ("SDF150",)
"""The codes of missing models and meshes, and of elements that are not read."""
_TEXT = "<the world>"


class WorldLoader:
    """The loader that replaces the running world.

    Args:
        server: the simulation.
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
            return decoded(read_bytes(path), str(path)).text != self._text
        except LinkwrightError:
            return True

    def load(self, uri: str, text: str = "", *, refused: Sequence[str] = ()) -> None:
        """Replace the running world by the world in a file or text.

        An error that the running world also has does not prevent the replacement.

        Args:
            uri: the file; empty for a text without a file.
            text: replaces the text of the file; empty to read the file.
            refused: codes of warnings that prevent the replacement.

        Raises:
            LinkwrightError: the world cannot be read or simulated; nothing has changed.
        """
        if not (uri or text):
            hint = phrase("give the file of a world, or its text")
            raise LinkwrightError(Diagnostic("SIM152", phrase("no world is given"), hint=hint))
        loaded = load_world(uri or str(Path.cwd() / _TEXT), text or None)
        known = {
            _essence(diagnostic)
            for diagnostic in (*self.loaded.diagnostics, *self._server.simulation.scene.diagnostics)
        }

        def allow(findings: Sequence[Diagnostic]) -> None:
            wrong = [
                finding
                for finding in findings
                if (finding.severity is Severity.ERROR or finding.code in refused) and _essence(finding) not in known
            ]
            if wrong:
                raise LinkwrightError(*wrong)

        allow(loaded.diagnostics)
        self._server.load(loaded.world, loaded.finder, allow)
        self.loaded = loaded
        self._text = text or None

    def answer(self, request: Any, response: Any) -> Any:
        """Handle a request to the ``/load_world`` service."""
        resource = request.world_resource
        refused = (
            *(() if request.ignore_missing_or_unsupported_assets else _MISSING),
            *(_NOT_READ if request.fail_on_unsupported_element else ()),
        )
        try:
            self.load(resource.uri, resource.resource_string, refused=refused)
        except LinkwrightError as error:
            finding = error.diagnostics[0]
            response.result.result = _result(finding)
            response.result.error_message = in_one_line(finding)
            return response
        response.result.result = _OK
        response.world.name = self.loaded.world.name
        response.world.world_resource = get_message("simulation_interfaces/msg/Resource")(uri=str(self.loaded.path))
        return response


def _result(finding: Diagnostic) -> int:
    if finding.code in _MISSING:
        return _MISSING_ASSETS
    if finding.code in _NOT_READ:
        return _UNSUPPORTED_ELEMENTS
    return _RESULTS.get(finding.code, _UNREADABLE)


def _essence(finding: Diagnostic) -> tuple[str, str]:
    return finding.code, str(finding.message)
