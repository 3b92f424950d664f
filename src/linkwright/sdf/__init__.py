"""Read SDF worlds and models, resolve includes, and compute poses."""
