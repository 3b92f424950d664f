"""Filters of laser scans, independent of ROS, with laser_filters' names and parameters."""
