"""The event handler ``launch_testing.event_handlers.StdoutReadyListener``."""

from __future__ import annotations

from typing import Any

from linkwright.launch.model import events
from linkwright.launch.model.process_event_handlers import OnProcessIO


class StdoutReadyListener(OnProcessIO):
    """An event handler that executes actions when a process writes a text to standard output.

    Args:
        target_action: the action of the process; None for all processes.
        ready_txt: the text to wait for.
        actions: the actions to execute.
    """

    def __init__(self, *, target_action: Any = None, ready_txt: str, actions: Any) -> None:
        self._actions = actions

        def react(event: events.ProcessIO) -> Any:
            return actions if ready_txt in event.text.decode(errors="replace") else None

        super().__init__(target_action=target_action, on_stdout=react)

    def describe(self) -> tuple[str, Any]:
        """Return a description of the handler for listings, and its actions."""
        return super().describe()[0], self._actions
