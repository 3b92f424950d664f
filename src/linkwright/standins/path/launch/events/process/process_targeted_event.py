"""Stands in for ``launch.events.process.process_targeted_event``."""

from linkwright.launch.events import ProcessTargetedEvent

__all__ = ["ProcessTargetedEvent"]
