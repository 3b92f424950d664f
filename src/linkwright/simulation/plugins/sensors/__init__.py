"""Sensors on the graph: plugins of Gazebo classic and those of ROS 1, and sensors of gz, which need none."""
