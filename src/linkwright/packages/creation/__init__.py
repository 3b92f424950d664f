"""Making new packages."""
