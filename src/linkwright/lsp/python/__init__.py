"""Python files in an editor: results of ty and ruff, and of Linkwright's own server."""
