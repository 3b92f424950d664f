"""Vehicles that an autopilot of another process controls."""
