"""The substitute for twist_mux, a package of the nodes of this room that has a launch file."""
