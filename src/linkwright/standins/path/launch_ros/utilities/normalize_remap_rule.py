"""Stands in for ``launch_ros.utilities.normalize_remap_rule``."""

from linkwright.launch.ros import normalize_remap_rule, normalize_remap_rules
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["normalize_remap_rule", "normalize_remap_rules"]
