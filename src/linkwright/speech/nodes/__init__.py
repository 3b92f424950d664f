"""Nodes of voice control, which capture sound, recognise commands, and execute them."""
