"""Configuration files of RViz: read, checked against the declared properties, changed in place, saved."""
