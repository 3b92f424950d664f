"""Sensor models without ROS that measure on request."""
