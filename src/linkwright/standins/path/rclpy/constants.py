"""Stands in for ``rclpy.constants``."""

S_TO_NS = 1_000_000_000

__all__ = ["S_TO_NS"]
