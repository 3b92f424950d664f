"""Controllers, one per file, which are found through entry points."""
