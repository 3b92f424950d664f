"""Poses of frames: sent to pages at the Frame Rate, and stored for a while to place messages by their time."""
