"""Folders for memory sticks from which a class installs Linkwright without a network."""
