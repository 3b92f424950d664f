"""Compare parameter files and other YAML files: their values, and the nodes and plugins that they name."""
