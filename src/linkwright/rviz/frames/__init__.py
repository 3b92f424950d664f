"""Frame poses: sent to pages at the Frame Rate, and stored to place messages at their time."""
