"""The nodes of the package turtlesim, with which the tutorials of ROS begin."""
