"""Plugins and sensors of models, which replace the libraries of Gazebo classic and gz.

They are found through entry points.
"""
