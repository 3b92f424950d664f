"""Stands in for ``tf2_ros.buffer_client``."""

from linkwright.standins.tf2_api.client import BufferClient

__all__ = ["BufferClient"]
