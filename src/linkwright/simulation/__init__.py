"""Worlds and their robots, moved by MuJoCo."""
