"""What a camera sees: detectors, where the things are, data to teach detectors with; without ROS."""
