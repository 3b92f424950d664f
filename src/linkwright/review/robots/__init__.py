"""Compare two robots: figures, reach, collisions and shared argument sets."""
