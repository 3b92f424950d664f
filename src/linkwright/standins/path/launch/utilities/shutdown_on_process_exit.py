"""Stands in for ``launch.utilities.shutdown_on_process_exit``."""

from linkwright.launch.class_checks import shutdown_on_process_exit

__all__ = ["shutdown_on_process_exit"]
