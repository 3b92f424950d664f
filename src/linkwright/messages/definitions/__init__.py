"""Find and parse the definitions of interfaces, and compute their hashes."""
