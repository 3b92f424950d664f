"""Substitutes for the Gazebo packages that launch files include, installed below one prefix."""
