"""The Voice panel: microphones of pages, recognized commands, and answers."""
