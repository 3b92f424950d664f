"""Hardware as controllers see it: interfaces, and ``<ros2_control>`` elements."""
