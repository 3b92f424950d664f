"""Errors in launch files: their locations, and the exceptions that ROS raises for them."""
