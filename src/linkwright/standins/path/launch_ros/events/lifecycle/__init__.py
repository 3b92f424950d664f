"""Stands in for ``launch_ros.events.lifecycle``."""

from linkwright.launch.ros import ChangeState, StateTransition, matches_node_name

__all__ = ["ChangeState", "StateTransition", "matches_node_name"]
