"""Other systems, as far as they can be told from here: what the code takes from one only, and a Python without it."""
