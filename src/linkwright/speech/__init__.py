"""Speech recognition, and the execution of spoken commands, without ROS."""
