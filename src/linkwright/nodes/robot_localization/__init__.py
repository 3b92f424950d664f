"""The nodes of robot_localization: they work out where the robot is of what several sensors measure."""
