"""What actions and substitutions need in order to be written in XML and YAML."""
