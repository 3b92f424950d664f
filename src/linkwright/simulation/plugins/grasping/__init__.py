"""Plugins of Gazebo Classic that hold objects: the grasp fix and the vacuum gripper."""
