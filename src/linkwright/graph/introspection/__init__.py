"""Graph queries: names, types, endpoints, and the traffic of topics."""
