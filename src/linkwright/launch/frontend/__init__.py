"""Launch files in XML and YAML, and what lets packages add tags and substitutions to them (``launch.frontend``)."""
