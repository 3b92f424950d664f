"""Words that the user has enrolled. They are recognised in any language, by their distance from the recordings."""
