"""The editor of source files in the page."""
