"""Sensors without ROS, which measure when they are asked to."""
