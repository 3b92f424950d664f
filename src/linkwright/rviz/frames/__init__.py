"""Frame poses: sent to pages at the Frame Rate, and stored for a while to place messages at their time."""
