"""The lint rules, one module for each topic; the entry point ``linkwright.lint_rules``."""
