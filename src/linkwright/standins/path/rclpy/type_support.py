"""Stands in for ``rclpy.type_support``."""

from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.type_support import (
    check_for_type_support,
    check_is_valid_msg_type,
    check_is_valid_srv_type,
)

__all__ = ["check_for_type_support", "check_is_valid_msg_type", "check_is_valid_srv_type"]
