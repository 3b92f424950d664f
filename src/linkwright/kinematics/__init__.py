"""Forward kinematics of a robot for one or many configurations, and kinematics of drives."""

from linkwright.kinematics.tree import KinematicTree, UnknownNameError

__all__ = ["KinematicTree", "UnknownNameError"]
