"""Python files in an editor: the answers of ty and ruff, beside those of Linkwright's own language server."""
