"""Plugins of RotorS: rotors, sensors and wind of multirotors."""
