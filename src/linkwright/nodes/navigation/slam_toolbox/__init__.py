"""The nodes of slam_toolbox: they make a map of laser scans and find the robot in it."""
