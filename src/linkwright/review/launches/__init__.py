"""Compare launch files: actions with their conditions, namespaces and settings, and the other code."""
