"""Plugins and sensors of models, found through entry points: the work of Gazebo classic's and gz's libraries."""
