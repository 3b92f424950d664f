"""Stands in for ``launch.events.process.signal_process``."""

from linkwright.launch.events import SignalProcess
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["SignalProcess"]
