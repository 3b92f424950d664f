"""Exercises with a judge.

An exercise has a world, a robot, and a figure that measures how well a program controls the robot.
"""

from linkwright.learning.judging.judge import Judge
from linkwright.learning.judging.scene import Scene

__all__ = ["Judge", "Scene"]
