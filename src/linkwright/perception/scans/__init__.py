"""Filters of laser scans, by the names and parameters of laser_filters. Arithmetic without ROS."""
