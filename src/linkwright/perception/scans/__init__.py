"""Filters of laser scans, with the names and parameters of laser_filters, independent of ROS."""
