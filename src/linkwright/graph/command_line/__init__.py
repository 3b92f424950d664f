"""The ROS arguments of a process, and the logging setup that they specify."""
