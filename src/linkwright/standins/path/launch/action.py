"""Stands in for ``launch.action``."""

from linkwright.launch.entity import Action
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["Action"]
