"""Behaviors for recovery, and zones around the robot that limit its velocity."""
