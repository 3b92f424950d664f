"""Voice commands: from sound to words, and from words to a robot's actions, without ROS."""
