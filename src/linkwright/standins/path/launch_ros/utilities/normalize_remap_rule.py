"""Stands in for ``launch_ros.utilities.normalize_remap_rule``."""

from linkwright.launch.ros import normalize_remap_rule, normalize_remap_rules

__all__ = ["normalize_remap_rule", "normalize_remap_rules"]
