"""Register actions and substitutions for XML and YAML, and parse their tags."""
