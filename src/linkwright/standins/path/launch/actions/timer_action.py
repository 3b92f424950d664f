"""Stands in for ``launch.actions.timer_action``."""

from linkwright.launch.actions import TimerAction

__all__ = ["TimerAction"]
