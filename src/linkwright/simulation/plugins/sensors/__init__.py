"""Sensors in the graph: plugins of Gazebo classic and ROS 1, and sensors of gz, which do not need plugins."""
