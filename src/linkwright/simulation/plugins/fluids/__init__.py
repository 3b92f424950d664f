"""Plugins for water and air: buoyancy, hydrodynamics, thrusters, wings and wind."""
