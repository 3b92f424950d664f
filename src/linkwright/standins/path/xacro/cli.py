"""Stands in for ``xacro.cli``."""

from linkwright.standins.xacro_api.command_line import REMAP, load_mappings, process_args

__all__ = ["REMAP", "load_mappings", "process_args"]
