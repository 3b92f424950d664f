"""Nodes of gazebo_ros, ros_gz_sim and ros_gz_bridge, which spawn models and bridge topics."""
