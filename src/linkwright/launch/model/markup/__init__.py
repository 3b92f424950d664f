"""Actions and substitutions in XML and YAML: registering them, reading their tags and values."""
