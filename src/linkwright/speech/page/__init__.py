"""The Voice panel: the microphones of pages, recognized commands, and answers."""
