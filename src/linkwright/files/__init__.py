"""Files and folders of the user, and the locations of the program's own data."""
