"""Substitutes for the Gazebo packages that launch files include, as a prefix with their share folders."""
