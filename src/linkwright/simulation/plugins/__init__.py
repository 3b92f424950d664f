"""Plugins and sensors of models, found through entry points: what libraries of Gazebo classic and gz do."""
