"""A visualization: a configuration, its displays and its edits, as one set of pages sees them."""
