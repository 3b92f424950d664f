"""Teleoperation: keyboards, joysticks, multiplexing and smoothing of velocities."""
