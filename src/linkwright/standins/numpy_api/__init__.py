"""Conversion between messages and numpy arrays (API of ``ros2_numpy``)."""
