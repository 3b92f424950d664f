"""Teleoperation with keyboards and joysticks, and multiplexing and smoothing of velocities."""
