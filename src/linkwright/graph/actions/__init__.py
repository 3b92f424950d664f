"""Actions: servers, clients and goals."""
