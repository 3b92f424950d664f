"""Estimators of pose and motion from measurements of sensors. Arithmetic without ROS."""
