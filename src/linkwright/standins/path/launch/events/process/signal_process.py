"""Stands in for ``launch.events.process.signal_process``."""

from linkwright.launch.events import SignalProcess

__all__ = ["SignalProcess"]
