"""Stand-ins for ROS modules that use launches. See `linkwright.standins`."""
