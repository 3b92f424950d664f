"""Plugins that report events: touches, losses of kinetic energy, and performers in a region."""
