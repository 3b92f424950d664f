"""Filters and conversions of sensor data: scans, images, inertial measurements."""
