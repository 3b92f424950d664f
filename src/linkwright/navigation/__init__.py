"""Localization, mapping, planning and path following.

Computations on grids, poses and scans, independent of ROS.
"""
