"""Simulate worlds and their robots with MuJoCo."""
