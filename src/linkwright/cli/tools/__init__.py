"""The commands of ROS 2 under their own names, for ``linkwright shell``."""
