"""A simulation in the graph: its thread, its topics, and its services."""
