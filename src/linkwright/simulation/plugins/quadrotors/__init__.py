"""Quadrotors that fly without rotors."""
