"""Stands in for ``rclpy.impl.implementation_singleton``, as far as the exceptions of rclpy's extension module go."""

from rclpy import _rclpy_pybind11 as rclpy_implementation

__all__ = ["rclpy_implementation"]
