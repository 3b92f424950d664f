"""Plugins of uuv_simulator: vehicles under water, their thrusters, and currents."""
