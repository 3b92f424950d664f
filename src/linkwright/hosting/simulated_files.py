"""The descriptions of a simulated world and its robot, reloaded from saved files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.descriptions import is_world
from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity
from linkwright.hosting.xacro_calls import Descriptions, WorldCall, XacroCall
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.descriptions import Description
    from linkwright.descriptions.conversion import ConversionResult


class SimulatedDescriptions(Descriptions):
    """The descriptions of a simulation: robots in simulated form, models in SDF, and worlds.

    Args:
        finder: the finder of ROS packages.
        complete_robot: returns the text of a robot to simulate, completed with inferred values.
    """

    def __init__(self, finder: PackageFinder, complete_robot: Callable[[Description], str]) -> None:
        super().__init__(finder)
        self._complete_robot = complete_robot

    def read(self, call: XacroCall) -> Any:
        """Return a robot, model or world that is read from its file.

        This method may run in another thread.

        Raises:
            LinkwrightError: the file is not valid. For a world, only errors that it did not have at the start are
                raised.
        """
        if not isinstance(call, WorldCall) and is_world(call.path.name):
            return self._read_model(call)
        return super().read(call)

    def store_result(self, call: XacroCall, description: Any) -> tuple[str | None, tuple[Diagnostic, ...]]:
        """Store a robot, model or world, and return its text and findings.

        For a world, the text is the path of its file. The text is None if the description has no robot.
        """
        if isinstance(call, WorldCall):
            return super().store_result(call, description)
        if is_world(call.path.name):
            from linkwright.sdf.writer import save

            return self.store_text(call, save(description.sdf.models[0]), description.files), description.diagnostics
        if description.robot is None:
            return None, description.diagnostics
        self.store(call, description)
        return self.store_text(call, self._complete_robot(description), description.files), description.diagnostics

    def store_text(self, call: XacroCall, text: str, files: tuple[Path, ...]) -> str:
        """Store a simulated text with all files from which it was created, and return the text."""
        self._calls[text] = call
        self._files[call] = files
        return text

    def _read_model(self, call: XacroCall) -> ConversionResult:
        from linkwright.descriptions.conversion import as_sdf

        self.record_read_time(call)
        converted = as_sdf(call.path, self.finder, arguments=dict(call.arguments), folder=Path.cwd())
        errors = [diagnostic for diagnostic in converted.diagnostics if diagnostic.severity is Severity.ERROR]
        if errors or converted.sdf is None or not converted.sdf.models:
            raise LinkwrightError(*errors or converted.diagnostics)
        return converted
