"""The lint rules of the entry point ``linkwright.lint_rules``, with one module for each topic."""
