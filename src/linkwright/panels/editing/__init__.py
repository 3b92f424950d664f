"""Edit a robot in the page."""
