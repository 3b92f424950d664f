"""Find the programs that launch files start, and what these programs offer and read."""
