"""The nodes of the packages of ros2_control."""
