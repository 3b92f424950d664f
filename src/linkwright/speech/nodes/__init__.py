"""Nodes of voice control: capturing sound, recognising commands, carrying them out."""
