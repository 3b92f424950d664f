"""The arithmetic of controllers, without ROS, so that each module can be tested in isolation."""
