"""Plugins and sensors that replace the libraries of Gazebo classic and gz.

The registry finds them through entry points.
"""
