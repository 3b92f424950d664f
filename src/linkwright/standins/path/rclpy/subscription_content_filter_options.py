"""Stands in for ``rclpy.subscription_content_filter_options``."""

from linkwright.graph.content_filter import ContentFilterOptions

__all__ = ["ContentFilterOptions"]
