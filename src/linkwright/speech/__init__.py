"""Turn speech into words, and words into a robot's actions, without ROS."""
