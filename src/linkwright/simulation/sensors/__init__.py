"""Sensors without ROS: each is asked to measure, and does so at once."""
