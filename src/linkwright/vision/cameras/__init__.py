"""Cameras of this machine: their images, and the calibration files that belong to them."""
