"""Map files: a YAML file with an image."""
