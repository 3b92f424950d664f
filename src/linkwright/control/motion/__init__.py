"""The arithmetic of controllers, without ROS: each module can be tested alone."""
