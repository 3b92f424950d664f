"""Hardware with its interfaces, and its description in ``<ros2_control>`` elements."""
