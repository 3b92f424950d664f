"""Stands in for ``launch.utilities.shutdown_on_process_exit``."""

from linkwright.launch.class_checks import shutdown_on_process_exit
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["shutdown_on_process_exit"]
