"""Nodes that spawn models and bridge topics.

They replace the programs of gazebo_ros, ros_gz_sim and ros_gz_bridge.
"""
