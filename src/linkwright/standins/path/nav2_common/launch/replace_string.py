"""Stands in for ``nav2_common.launch.replace_string``."""

from linkwright.launch.rewriting import ReplaceString

__all__ = ["ReplaceString"]
