"""What a reader sees of two robots: their figures, reach, collisions and shared argument sets."""
