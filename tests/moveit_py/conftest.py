"""Make MoveIt's Python library and rclpy importable."""

from __future__ import annotations

from linkwright.standins import activate

activate()
