"""The nodes of cartographer_ros: mapping with laser scans, point clouds and odometry."""
