"""Sensors in the graph, for Gazebo classic, ROS 1 and gz.

Gazebo classic and ROS 1 declare them as plugins, and gz as sensors without plugins.
"""
