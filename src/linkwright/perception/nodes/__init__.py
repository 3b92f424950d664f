"""Nodes that filter and convert sensor data, with the names of ROS packages."""
