"""Sensor models without ROS, which measure on request."""
