"""Simulation of worlds and their robots with MuJoCo."""
