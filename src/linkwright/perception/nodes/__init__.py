"""Nodes that filter and convert scans, clouds, images and inertial measurements, under the names of ROS packages."""
