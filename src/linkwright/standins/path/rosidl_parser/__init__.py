"""Stands in for rosidl_parser, of which code written for rclpy looks at the types of fields."""

__all__: list[str] = []
