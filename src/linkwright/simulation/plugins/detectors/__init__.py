"""Plugins that report touches, losses of kinetic energy, and performers in a region."""
