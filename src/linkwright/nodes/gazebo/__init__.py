"""Nodes of gazebo_ros, ros_gz_sim and ros_gz_bridge: those that put models into the world, and bridges."""
