"""Errors in launch files: their locations, and the exceptions that programs expect from ROS."""
