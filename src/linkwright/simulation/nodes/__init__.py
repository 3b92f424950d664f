"""Nodes that spawn models and bridge topics, as in gazebo_ros, ros_gz_sim and ros_gz_bridge."""
