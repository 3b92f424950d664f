"""Create new packages."""
