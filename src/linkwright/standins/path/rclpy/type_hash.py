"""Stands in for ``rclpy.type_hash``."""

from linkwright.standins.rclpy_api.type_hash import TypeHash, TypeHashDictionary

__all__ = ["TypeHash", "TypeHashDictionary"]
