"""Reading launch files: Python, XML, YAML, and the substitutions in their texts."""
