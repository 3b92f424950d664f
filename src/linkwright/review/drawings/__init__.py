"""Drawings in reports: images and scenes in 3D."""
