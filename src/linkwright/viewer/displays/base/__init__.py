"""What classes of displays are derived from."""
