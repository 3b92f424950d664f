"""Questions to the graph: names, types, endpoints, and the traffic of topics."""
