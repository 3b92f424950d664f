"""Hardware as controllers see it: interfaces, and the ``<ros2_control>`` of a description."""
