"""A visualization: a configuration, its displays and its edits, shared by a group of pages."""
