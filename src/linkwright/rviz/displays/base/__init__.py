"""The base classes of displays."""
