"""Stands in for ``launch_ros.events.lifecycle``."""

from linkwright.launch.ros import ChangeState, StateTransition, matches_node_name
from linkwright.standins.imported_names import submodules_of

__all__ = ["ChangeState", "StateTransition", "matches_node_name"]

__getattr__ = submodules_of(__name__)
