"""Substitutes for the Gazebo packages that launch files include.

They are installed below one prefix.
"""
