"""The nodes that the packages of ros2_control provide."""
