"""Poses of frames: sent to pages at the Frame Rate, and kept for a while to place messages by their time."""
