"""Stands in for ``launch.events.process.process_targeted_event``."""

from linkwright.launch.events import ProcessTargetedEvent
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ProcessTargetedEvent"]
