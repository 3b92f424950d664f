"""The Voice panel: the microphones of pages, and what is heard and answered."""
