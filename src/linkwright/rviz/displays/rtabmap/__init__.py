"""The displays of rtabmap: the clouds of a map, its graph, and its statistics."""
