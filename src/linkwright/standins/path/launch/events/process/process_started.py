"""Stands in for ``launch.events.process.process_started``."""

from linkwright.launch.events import ProcessStarted
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ProcessStarted"]
