"""The displays of the Displays panel, one file each."""
