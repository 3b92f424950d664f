"""Filters and conversions of sensor data: scans, images and inertial measurements."""
