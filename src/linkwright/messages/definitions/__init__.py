"""The definitions of interfaces: where they are found, reading them, and their hashes."""
