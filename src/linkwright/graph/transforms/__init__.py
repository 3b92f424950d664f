"""tf2: transforms over time, with broadcasters, listeners and buffers."""
