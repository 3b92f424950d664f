"""What one set of pages sees: a configuration, its displays, and what was edited in it."""
