"""The displays of the Displays panel, one module each."""
