"""Coverage-guided fuzzing of all readers of files from unknown sources."""
