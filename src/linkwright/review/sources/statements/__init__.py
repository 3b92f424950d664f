"""Compare the statements of two versions of a source."""
