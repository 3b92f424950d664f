"""Modules of ROS that are made of launches, for programs that import them: see `linkwright.standins`."""
