"""The rules, a module for each group or topic; the entry point ``linkwright.lint_rules`` names this package."""
