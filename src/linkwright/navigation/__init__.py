"""Where a robot is, and how it gets elsewhere: arithmetic on grids, poses and scans, without ROS."""
