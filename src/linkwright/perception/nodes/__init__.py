"""Nodes that filter and convert sensor data, with the names of nodes in ROS packages."""
