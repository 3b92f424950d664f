"""Localization, mapping, planning and path following: arithmetic on grids, poses and scans, without ROS."""
