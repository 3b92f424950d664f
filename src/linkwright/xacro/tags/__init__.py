"""The tags of the language: one module for each family."""
