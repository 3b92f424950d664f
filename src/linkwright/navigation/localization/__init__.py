"""Where a robot is on a map that is known."""
