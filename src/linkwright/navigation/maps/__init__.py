"""Map files: a YAML file and an image."""
