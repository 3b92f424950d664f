"""Registration of actions and substitutions in XML and YAML, and parsing of their tags."""
