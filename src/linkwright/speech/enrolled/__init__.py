"""Words that the user has enrolled, recognised in any language by their distance from the recordings."""
