"""The displays of the Displays panel, a file each."""
