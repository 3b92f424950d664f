"""Controllers, a file each, found through entry points."""
