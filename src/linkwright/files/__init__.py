"""Functions for the user's files and folders, and the folders for the program's own data."""
