"""Estimators: where a robot is and how it moves, worked out of what sensors measure. Arithmetic without ROS."""
