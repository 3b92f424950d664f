"""Path planning on costmaps."""
