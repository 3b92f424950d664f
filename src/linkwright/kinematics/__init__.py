"""Forward kinematics of a robot, for one or many configurations."""

from linkwright.kinematics.tree import KinematicTree, UnknownNameError

__all__ = ["KinematicTree", "UnknownNameError"]
