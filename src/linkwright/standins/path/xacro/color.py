"""Stands in for ``xacro.color``."""

from linkwright.standins.xacro_api.colour import colorize, error, is_tty, message, warning

__all__ = ["colorize", "error", "is_tty", "message", "warning"]
