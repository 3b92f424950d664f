"""The ROS arguments of a process, and the logging that they configure."""
