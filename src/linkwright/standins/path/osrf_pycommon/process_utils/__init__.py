"""Stands in for ``osrf_pycommon.process_utils``."""

from linkwright.launch.class_checks import get_loop

__all__ = ["get_loop"]
