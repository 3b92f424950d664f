"""A simulation on the graph: its thread, its topics, and its services."""
