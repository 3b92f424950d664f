"""The elements of launch descriptions; this package reads no files and starts no processes."""
