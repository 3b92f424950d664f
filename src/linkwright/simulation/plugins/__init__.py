"""Plugins and sensors of models, which replace the libraries of Gazebo classic and gz.

The registry finds them through entry points.
"""
