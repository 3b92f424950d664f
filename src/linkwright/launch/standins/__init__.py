"""Stand-ins for ROS modules that build on launches; see `linkwright.standins`."""
