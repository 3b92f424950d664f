"""Edit a world in the page."""
