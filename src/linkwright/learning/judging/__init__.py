"""Exercises with a judge: a world, a robot, and a figure that measures how well a program controls it."""

from linkwright.learning.judging.judge import Judge
from linkwright.learning.judging.scene import Scene

__all__ = ["Judge", "Scene"]
