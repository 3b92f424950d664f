"""tf2: transforms over time, their broadcasters and their users."""
