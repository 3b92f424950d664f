"""The definitions of interfaces: how they are found and parsed, and their hashes."""
