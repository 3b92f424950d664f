"""The computations of controllers, independent of ROS."""
