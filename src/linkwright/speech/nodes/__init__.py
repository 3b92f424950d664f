"""Nodes of voice control: audio capture, and the recognition and execution of commands."""
