"""Nodes for teleoperation with keyboards and joysticks, and a multiplexer of velocities."""
