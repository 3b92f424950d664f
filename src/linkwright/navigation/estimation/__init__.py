"""Estimators of pose and motion from sensor measurements, independent of ROS."""
