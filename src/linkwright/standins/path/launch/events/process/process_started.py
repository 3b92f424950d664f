"""Stands in for ``launch.events.process.process_started``."""

from linkwright.launch.events import ProcessStarted

__all__ = ["ProcessStarted"]
