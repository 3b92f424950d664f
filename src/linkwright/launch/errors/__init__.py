"""Errors in launch files: places in the user's files, and the exceptions that programs expect from ROS."""
