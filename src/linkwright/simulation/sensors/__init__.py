"""What sensors measure in a world that moves, without ROS: each is asked, and measures at this moment."""
