"""Velocities that keep a robot on its path."""
