"""Stands in for ``launch.utilities.signal_management``."""

from linkwright.launch.signal_manager import AsyncSafeSignalManager
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["AsyncSafeSignalManager"]
