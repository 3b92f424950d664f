"""Hardware as controllers see it: interfaces, and what ``<ros2_control>`` of a description declares."""
