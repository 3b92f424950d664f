"""Object detection, positions of objects, and datasets for detectors, without ROS."""
