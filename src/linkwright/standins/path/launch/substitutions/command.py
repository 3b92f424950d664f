"""Stands in for ``launch.substitutions.command``."""

from linkwright.launch.substitutions import Command
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["Command"]
