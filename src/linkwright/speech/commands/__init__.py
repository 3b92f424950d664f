"""Commands: phrases with numbers and units, and the file that maps phrases to actions."""
