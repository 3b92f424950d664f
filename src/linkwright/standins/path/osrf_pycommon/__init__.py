"""Stands in for ``osrf_pycommon``."""

from osrf_pycommon import process_utils

__all__ = ["process_utils"]
