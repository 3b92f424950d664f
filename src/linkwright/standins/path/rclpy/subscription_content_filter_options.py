"""Stands in for ``rclpy.subscription_content_filter_options``."""

from linkwright.standins.rclpy_api.content_filter import ContentFilterOptions

__all__ = ["ContentFilterOptions"]
