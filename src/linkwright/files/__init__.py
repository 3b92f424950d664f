"""Functions for files and folders of the user, and the folders for the program's own data."""
