"""Navigation nodes, under their names in nav2, slam_toolbox and robot_localization."""
