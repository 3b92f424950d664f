"""Controllers, one per file, found through entry points."""
