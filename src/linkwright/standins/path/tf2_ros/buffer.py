"""Stands in for ``tf2_ros.buffer``."""

from linkwright.standins.tf2_api.buffer import Buffer

__all__ = ["Buffer"]
