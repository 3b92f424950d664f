"""Localization, mapping, planning and path following.

The computations work on grids, poses and scans, and do not depend on ROS.
"""
