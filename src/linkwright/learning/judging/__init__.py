"""Exercises with a judge: a world, a robot, and a figure that tells how well a program drives it."""

from linkwright.learning.judging.judge import Judge
from linkwright.learning.judging.scene import Scene

__all__ = ["Judge", "Scene"]
