"""The definitions of interfaces: find them, parse them, and compute their hashes."""
