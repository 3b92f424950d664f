"""Nodes that filter and convert sensor data, with the node names of ROS packages."""
