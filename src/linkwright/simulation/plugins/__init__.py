"""Plugins and sensors of models, found through entry points; they replace the libraries of Gazebo classic and gz."""
