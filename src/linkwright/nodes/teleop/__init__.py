"""Nodes that steer robots by hand: keyboards, joysticks, and what chooses between velocities and smooths them."""
