"""Plugins of the flying models of PX4 for Gazebo Classic, without its protocol MAVLink."""
