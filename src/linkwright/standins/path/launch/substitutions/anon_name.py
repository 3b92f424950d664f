"""Stands in for ``launch.substitutions.anon_name``."""

from linkwright.launch.substitutions import AnonName
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["AnonName"]
