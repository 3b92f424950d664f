"""The lint rules of the entry point ``linkwright.lint_rules``, one module per topic."""
