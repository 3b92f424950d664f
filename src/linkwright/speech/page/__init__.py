"""The Voice panel: microphones of pages, recognised commands, and answers."""
