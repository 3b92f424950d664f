"""The computations of controllers, which do not depend on ROS."""
